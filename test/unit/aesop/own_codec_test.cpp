#include "laparoscope_servo/aesop/own_codec.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <map>
#include <sstream>
#include <stdexcept>

#include "messages.h"

namespace laparoscope_servo::aesop {
namespace {

TEST(OwnCodec, everyMessageComesBack) {
  std::uint16_t sequence = 65530;
  for (const Message& message : oneOfEach()) {
    Decoder decoder;
    const std::vector<Frame> frames = decoder.push(encode({++sequence, message}));
    ASSERT_EQ(frames.size(), 1u);
    EXPECT_EQ(frames[0].sequence, sequence);
    EXPECT_EQ(frames[0].message.index(), message.index());
    EXPECT_EQ(decoder.statistics().skipped_bytes, 0u);
  }
}

TEST(OwnCodec, valuesComeBackToAMillionth) {
  Decoder decoder;
  const Status sent = someStatus();
  const Status got = std::get<Status>(decoder.push(encode({7, sent}))[0].message);
  EXPECT_EQ(got.state, sent.state);
  EXPECT_EQ(got.homed, sent.homed);
  EXPECT_EQ(got.moving, sent.moving);
  EXPECT_EQ(got.faults, sent.faults);
  EXPECT_EQ(got.echo, sent.echo);
  EXPECT_NEAR(got.time, sent.time, 5e-4);
  EXPECT_LE((got.position - sent.position).lpNorm<Eigen::Infinity>(), 0.5e-6 + 1e-12);
  EXPECT_LE((got.velocity - sent.velocity).lpNorm<Eigen::Infinity>(), 0.5e-6 + 1e-12);
  const Velocity velocity{{0.001, -0.3, 0.2, -0.5}, 0.2};
  const Velocity back = std::get<Velocity>(decoder.push(encode({8, velocity}))[0].message);
  for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR(back.speed[k], velocity.speed[k], 1e-9);
  EXPECT_DOUBLE_EQ(back.time_to_live, 0.2);
  const Identity identity{7, 0x47, "sixteen letters!"};
  EXPECT_EQ(std::get<Identity>(decoder.push(encode({9, identity}))[0].message).model, identity.model);
}

// The worked examples of doc/aesop_protocol.md, read from there: lines of "example NAME", then indented bytes.
std::map<std::string, Bytes> documentedExamples() {
  std::ifstream file(PROTOCOL_DOCUMENT);
  std::map<std::string, Bytes> examples;
  std::string name;
  for (std::string line; std::getline(file, line);) {
    if (line.rfind("Example `", 0) == 0) {
      name = line.substr(9, line.find('`', 9) - 9);
    } else if (!name.empty() && line.rfind("    ", 0) == 0) {
      std::istringstream bytes(line);
      for (unsigned byte = 0; bytes >> std::hex >> byte;) examples[name].push_back(static_cast<std::uint8_t>(byte));
    } else if (line.rfind('#', 0) == 0) {
      name.clear();
    }
  }
  return examples;
}

template <typename T>
T decodeExample(const std::string& name, std::uint16_t sequence) {
  const Bytes bytes = documentedExamples()[name];
  const std::vector<Frame> frames = Decoder().push(bytes);
  if (frames.size() != 1 || !std::holds_alternative<T>(frames[0].message))
    throw std::runtime_error("no such example: " + name);
  EXPECT_EQ(frames[0].sequence, sequence) << name;
  EXPECT_EQ(encode(frames[0]), bytes) << name << " is not what the encoder writes";
  return std::get<T>(frames[0].message);
}

TEST(OwnCodec, documentedExamples) {
  EXPECT_EQ(documentedExamples().size(), 5u);
  decodeExample<Identify>("identify", 0);
  decodeExample<Enable>("enable", 1);
  const Velocity velocity = decodeExample<Velocity>("velocity", 258);
  EXPECT_DOUBLE_EQ(velocity.time_to_live, 0.2);
  EXPECT_DOUBLE_EQ(velocity.speed[0], -0.0004);
  EXPECT_DOUBLE_EQ(velocity.speed[2], -0.0033);
  const Identity identity = decodeExample<Identity>("identity", 0);
  EXPECT_EQ(identity.joints, 7);
  EXPECT_EQ(identity.driven, 0x47);
  EXPECT_EQ(identity.model, "EMULATED AESOP");
  const Status status = decodeExample<Status>("status", 258);
  EXPECT_EQ(status.state, RobotState::kEnabled);
  EXPECT_TRUE(status.homed && status.moving);
  EXPECT_EQ(status.faults, 0);
  EXPECT_EQ(status.echo, 258);
  EXPECT_DOUBLE_EQ(status.time, 12.345);
  EXPECT_DOUBLE_EQ(status.position[1], -0.9);
  EXPECT_DOUBLE_EQ(status.velocity[6], 0.005);
}

TEST(OwnCodec, encoderRefusesWhatHasNoNumber) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double inf = std::numeric_limits<double>::infinity();
  for (const double bad : {nan, inf, -inf, 2001.0, 1e300}) {
    EXPECT_THROW(encode({1, Velocity{{0.0, bad, 0.0, 0.0}, 0.1}}), std::invalid_argument);
    EXPECT_THROW(encode({1, Velocity{{0.0, 0.0, 0.0, 0.0}, bad}}), std::invalid_argument);
    Status status = someStatus();
    status.position[3] = bad;
    EXPECT_THROW(encode({1, status}), std::invalid_argument);
    status = someStatus();
    status.velocity[6] = bad;
    EXPECT_THROW(encode({1, status}), std::invalid_argument);
  }
  EXPECT_THROW(encode({1, Velocity{{}, 0.0}}), std::invalid_argument);
  EXPECT_THROW(encode({1, Identity{7, 0, "seventeen letters"}}), std::invalid_argument);
  EXPECT_THROW(encode({1, Identity{7, 0, "tab\t"}}), std::invalid_argument);
}

TEST(Messages, unknownFaultBitsAreFaults) {
  EXPECT_EQ(describeFaults(0), "");
  EXPECT_EQ(describeFaults(kFaultMotor), "motor");
  EXPECT_EQ(describeFaults(kFaultMotor | 0x8000), "motor, unknown fault bits 0x8000");
}

}  // namespace
}  // namespace laparoscope_servo::aesop
