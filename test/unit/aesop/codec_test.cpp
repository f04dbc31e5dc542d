#include "laparoscope_servo/aesop/codec.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <map>
#include <random>
#include <sstream>
#include <stdexcept>

namespace laparoscope_servo::aesop {
namespace {

Status someStatus() {
  Status status;
  status.state = RobotState::kEnabled;
  status.homed = true;
  status.moving = true;
  status.faults = 0x8002;
  status.echo = 0xFFFE;
  status.time = 12.345;
  status.position << 0.25, -0.9, 1.5, 0.0, 0.001, -0.002, -12.5;
  status.velocity << -0.0004, 0.003, 0.0, 0.0, 1e-6, -1e-6, 0.5;
  return status;
}

std::vector<Message> oneOfEach() {
  return {Identify(),
          Enable(),
          Disable(),
          Stop(),
          ClearFault(),
          Poll(),
          Velocity{{0.001, -0.3, 0.2, -0.5}, 0.2},
          Identity{7, 0x47, "emulator"},
          someStatus()};
}

TEST(Codec, everyMessageComesBack) {
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

TEST(Codec, valuesComeBackToAMillionth) {
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

TEST(Codec, documentedExamples) {
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

// CRC-16/CCITT-FALSE, written a second time: bit by bit.
std::uint16_t crcBitwise(const Bytes& bytes, std::size_t from) {
  std::uint32_t sum = 0xFFFF;
  for (std::size_t k = from; k < bytes.size(); ++k) {
    sum ^= static_cast<std::uint32_t>(bytes[k]) << 8;
    for (int bit = 0; bit < 8; ++bit) sum = (sum & 0x8000u) != 0 ? ((sum << 1) ^ 0x1021u) & 0xFFFFu : sum << 1;
  }
  return static_cast<std::uint16_t>(sum);
}

Bytes frameOf(std::uint8_t version, std::uint8_t type, const Bytes& payload) {
  Bytes bytes = {0xA5, 0x5A, version, static_cast<std::uint8_t>(payload.size()), type, 0x07, 0x00};
  for (const std::uint8_t byte : payload) bytes.push_back(byte);
  const std::uint16_t sum = crcBitwise(bytes, 2);
  bytes.push_back(static_cast<std::uint8_t>(sum & 0xFF));
  bytes.push_back(static_cast<std::uint8_t>(sum >> 8));
  return bytes;
}

TEST(Codec, sumIsCcittFalse) {
  const Bytes check = {'1', '2', '3', '4', '5', '6', '7', '8', '9'};
  EXPECT_EQ(crcBitwise(check, 0), 0x29B1);  // the check value of its definition
  EXPECT_EQ(frameOf(1, 0x06, {}), encode({7, Poll()}));
}

TEST(Codec, malformedFramesAreCountedAndNotDelivered) {
  Bytes velocity(18, 0);
  velocity[0] = 200;
  ASSERT_EQ(Decoder().push(frameOf(1, 0x07, velocity)).size(), 1u);
  Bytes no_time = velocity;
  no_time[0] = 0;
  Bytes long_time = velocity;
  long_time[1] = 0x10;
  Bytes status(66, 0);
  ASSERT_EQ(Decoder().push(frameOf(1, 0x82, status)).size(), 1u);
  Bytes unknown_state = status;
  unknown_state[0] = 3;
  Bytes unknown_flag = status;
  unknown_flag[1] = 4;
  Bytes identity(18, 0);
  ASSERT_EQ(Decoder().push(frameOf(1, 0x81, identity)).size(), 1u);
  Bytes unprintable = identity;
  unprintable[2] = 0x07;
  Bytes after_end = identity;
  after_end[10] = 'x';
  const std::vector<Bytes> malformed = {
      frameOf(1, 0x07, no_time),
      frameOf(1, 0x07, long_time),
      frameOf(1, 0x07, Bytes(17, 1)),
      frameOf(1, 0x07, Bytes(19, 1)),
      frameOf(1, 0x82, unknown_state),
      frameOf(1, 0x82, unknown_flag),
      frameOf(1, 0x82, Bytes(65, 0)),
      frameOf(1, 0x81, unprintable),
      frameOf(1, 0x81, after_end),
      frameOf(1, 0x02, Bytes(1, 0)),
      frameOf(1, 0x00, {}),
      frameOf(1, 0x83, {}),
  };
  for (const Bytes& bytes : malformed) {
    Decoder decoder;
    EXPECT_TRUE(decoder.push(bytes).empty());
    EXPECT_EQ(decoder.statistics().malformed, 1u);
    EXPECT_EQ(decoder.push(encode({1, Poll()})).size(), 1u);
  }
}

TEST(Codec, otherVersionIsCountedAndNotDelivered) {
  Decoder decoder;
  EXPECT_TRUE(decoder.push(frameOf(2, 0x06, {})).empty());
  EXPECT_EQ(decoder.statistics().other_version, 1u);
  EXPECT_EQ(decoder.statistics().malformed, 0u);
}

TEST(Codec, bytesOneByOne) {
  Bytes stream;
  for (const Message& message : oneOfEach()) {
    const Bytes frame = encode({1, message});
    stream.insert(stream.end(), frame.begin(), frame.end());
  }
  Decoder decoder;
  std::size_t frames = 0;
  for (const std::uint8_t byte : stream) frames += decoder.push(&byte, 1).size();
  EXPECT_EQ(frames, oneOfEach().size());
  EXPECT_EQ(Decoder().push(stream).size(), oneOfEach().size());
}

TEST(Codec, findsItsWayBackAfterGarbage) {
  const Bytes good = encode({5, someStatus()});
  std::vector<Bytes> garbage = {
      {0x00, 0xFF, 0x13},
      {0xA5},                                            // half a marker
      {0xA5, 0x5A, 0x01, 0xFF, 0x82, 0x00, 0x00},        // a length that no frame has
      {0xA5, 0x5A, 0x01, 0x00, 0x06, 0x00, 0x00, 1, 2},  // a wrong sum
      Bytes(good.begin(), good.begin() + 30),            // a frame that breaks off
  };
  for (const Bytes& before : garbage) {
    Decoder decoder;
    std::size_t frames = decoder.push(before).size();
    frames += decoder.push(good).size();
    frames += decoder.push(good).size();  // what broke off may cost one good frame's wait, never the frame
    EXPECT_EQ(frames, 2u);
    EXPECT_EQ(decoder.statistics().skipped_bytes, before.size());
  }
}

TEST(Codec, everyFlippedBitIsFound) {
  const Bytes good = encode({5, Velocity{{0.01, 0.02, 0.03, 0.04}, 0.1}});
  for (std::size_t bit = 0; bit < 8 * good.size(); ++bit) {
    Bytes bad = good;
    bad[bit / 8] = static_cast<std::uint8_t>(bad[bit / 8] ^ (1u << (bit % 8)));
    EXPECT_TRUE(Decoder().push(bad).empty()) << "bit " << bit;
  }
}

TEST(Codec, lostAndDoubledBytesAreFound) {
  const Bytes good = encode({5, Velocity{{0.01, 0.02, 0.03, 0.04}, 0.1}});
  for (std::size_t at = 2; at < good.size(); ++at) {
    Bytes lost = good;
    lost.erase(lost.begin() + static_cast<std::ptrdiff_t>(at));
    Bytes doubled = good;
    doubled.insert(doubled.begin() + static_cast<std::ptrdiff_t>(at), good[at]);
    for (const Bytes& bad : {lost, doubled}) {
      Decoder decoder;
      std::vector<Frame> frames = decoder.push(bad);
      for (const Frame& frame : decoder.push(good)) frames.push_back(frame);
      for (const Frame& frame : decoder.push(good)) frames.push_back(frame);
      // Zero bytes in a row may be doubled into an equal frame plus a byte of garbage; nothing else may come of it.
      for (const Frame& frame : frames) {
        EXPECT_EQ(frame.sequence, 5);
        ASSERT_TRUE(std::holds_alternative<Velocity>(frame.message));
        EXPECT_NEAR(std::get<Velocity>(frame.message).speed[3], 0.04, 1e-9);
      }
      EXPECT_GE(frames.size(), 2u);
    }
  }
}

TEST(Codec, randomBytesMakeNoFrameAndNoGrowth) {
  std::mt19937 random(1);
  Decoder decoder;
  std::size_t frames = 0;
  for (int k = 0; k < 200000; ++k) {
    // Markers more often than chance has them, to reach the code behind them.
    const std::uint32_t draw = random();
    const std::uint8_t byte = draw % 5 == 0 ? 0xA5 : draw % 5 == 1 ? 0x5A : static_cast<std::uint8_t>(draw >> 8);
    frames += decoder.push(&byte, 1).size();
  }
  EXPECT_EQ(frames, 0u);
  EXPECT_GT(decoder.statistics().crc_errors, 100u);
  EXPECT_EQ(decoder.push(encode({1, Poll()})).size() + decoder.push(Bytes(100, 0)).size(), 1u);
}

TEST(Codec, encoderRefusesWhatHasNoNumber) {
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

TEST(Codec, sequenceNumbersWrap) {
  EXPECT_EQ(compareSequence(5, 5), 0);
  EXPECT_EQ(compareSequence(6, 5), 1);
  EXPECT_EQ(compareSequence(5, 6), -1);
  EXPECT_EQ(compareSequence(2, 65530), 1);
  EXPECT_EQ(compareSequence(65530, 2), -1);
}

TEST(Messages, unknownFaultBitsAreFaults) {
  EXPECT_EQ(describeFaults(0), "");
  EXPECT_EQ(describeFaults(kFaultMotor), "motor");
  EXPECT_EQ(describeFaults(kFaultMotor | 0x8000), "motor, unknown fault bits 0x8000");
}

}  // namespace
}  // namespace laparoscope_servo::aesop
