// What every codec promises, and what the session does with one that cannot carry what it is given.
#include "laparoscope_servo/aesop/codec.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "laparoscope_servo/aesop/session.h"
#include "laparoscope_servo/sim/emulator.h"
#include "unit/aesop/line_codec.h"
#include "unit/aesop/messages.h"

namespace laparoscope_servo::aesop {
namespace {

TEST(Codec, isFoundByName) {
  ASSERT_FALSE(codecNames().empty());
  for (const std::string& name : codecNames()) EXPECT_FALSE(codecNamed(name)()->name().empty());
  EXPECT_EQ(codecNamed("own")()->name(), makeOwnCodec()->name());
  try {
    codecNamed("vendor");
    FAIL() << "there is no such codec";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("'vendor', expected one of: own"), std::string::npos) << error.what();
  }
}

TEST(Codec, sequenceNumbersWrap) {
  EXPECT_EQ(compareSequence(5, 5), 0);
  EXPECT_EQ(compareSequence(6, 5), 1);
  EXPECT_EQ(compareSequence(5, 6), -1);
  EXPECT_EQ(compareSequence(2, 65530), 1);
  EXPECT_EQ(compareSequence(65530, 2), -1);
}

// What doc/aesop_protocol.md asks of any codec; to be instantiated for another one.
template <typename T>
class AnyCodec : public ::testing::Test {};
using Codecs = ::testing::Types<OwnCodec, LineCodec>;
TYPED_TEST_SUITE(AnyCodec, Codecs);

TYPED_TEST(AnyCodec, everyMessageComesBackInPiecesOfAnyLength) {
  for (std::size_t piece = 1; piece < 40; ++piece) {
    TypeParam host;
    TypeParam controller;
    std::uint16_t sequence = 65530;
    Bytes stream;
    for (const Message& message : oneOfEach()) {
      const Bytes bytes = host.encode({++sequence, message});
      EXPECT_LE(bytes.size(), host.longestFrame());
      stream.insert(stream.end(), bytes.begin(), bytes.end());
    }
    std::vector<Frame> frames;
    for (std::size_t at = 0; at < stream.size(); at += piece) {
      for (const Frame& frame : controller.push(stream.data() + at, std::min(piece, stream.size() - at))) {
        frames.push_back(frame);
      }
    }
    ASSERT_EQ(frames.size(), oneOfEach().size());
    for (std::size_t k = 0; k < frames.size(); ++k) {
      EXPECT_EQ(frames[k].message.index(), oneOfEach()[k].index());
      EXPECT_EQ(frames[k].sequence, static_cast<std::uint16_t>(65531 + k));
      EXPECT_EQ(host.encode(frames[k]), host.encode({frames[k].sequence, oneOfEach()[k]}));
    }
    EXPECT_EQ(controller.statistics().frames, frames.size());
    EXPECT_EQ(controller.statistics().skipped_bytes, 0u);
  }
}

TYPED_TEST(AnyCodec, damageIsFoundAndOutlived) {
  TypeParam codec;
  const Bytes good = codec.encode({5, Velocity{{0.01, 0.02, 0.03, 0.04}, 0.1}});
  for (std::size_t bit = 0; bit < 8 * good.size(); ++bit) {
    Bytes bad = good;
    bad[bit / 8] = static_cast<std::uint8_t>(bad[bit / 8] ^ (1u << (bit % 8)));
    TypeParam receiver;
    EXPECT_TRUE(receiver.push(bad.data(), bad.size()).empty()) << "bit " << bit;
    std::size_t frames = receiver.push(good.data(), good.size()).size();
    frames += receiver.push(good.data(), good.size()).size();
    EXPECT_GE(frames, 1u) << "bit " << bit;
  }
}

TYPED_TEST(AnyCodec, resetForgetsHalfAFrame) {
  TypeParam codec;
  const Bytes bytes = codec.encode({5, someStatus()});
  EXPECT_TRUE(codec.push(bytes.data(), bytes.size() / 2).empty());
  codec.reset();
  EXPECT_EQ(codec.push(bytes.data(), bytes.size()).size(), 1u);
}

// A format that is narrower than the messages allow.
class NarrowCodec : public OwnCodec {
 public:
  Bytes encode(const Frame& frame) override {
    const auto* velocity = std::get_if<Velocity>(&frame.message);
    if (velocity != nullptr && velocity->speed[0] > 0.01) throw std::invalid_argument("speed is more than 0.01");
    return OwnCodec::encode(frame);
  }
};

TEST(Codec, whatItCannotCarryIsAStop) {
  SessionConfig config;
  config.codec = [] { return std::make_unique<NarrowCodec>(); };
  Session session(config, 0x47);
  sim::Emulator emulator(sim::EmulatorConfig(), 0.0);
  double now = 0.0;
  session.opened(now);
  const auto run = [&](double speed, int steps) {
    for (int k = 0; k < steps; ++k) {
      now += 0.005;
      const Bytes requests = session.transmit({speed, 0.0, 0.0, 0.0}, now);
      const Bytes replies = emulator.receive(requests.data(), requests.size(), now);
      session.receive(replies.data(), replies.size(), now);
    }
  };
  run(0.0, 20);
  ASSERT_EQ(session.enable(now), "");
  run(0.01, 100);
  EXPECT_TRUE(emulator.arm().isMoving());
  EXPECT_EQ(session.state().reason, "");
  run(0.02, 100);
  EXPECT_FALSE(emulator.arm().isMoving());
  EXPECT_EQ(session.state().mode, OperatingMode::kEnabled);
  EXPECT_NE(session.state().reason.find("more than 0.01"), std::string::npos) << session.state().reason;
  run(0.01, 100);
  EXPECT_TRUE(emulator.arm().isMoving());
  EXPECT_EQ(session.state().reason, "");
}

TEST(Codec, twoFormatsOnOneLineNeverComeUp) {
  sim::EmulatorConfig lines;
  lines.codec = [] { return std::make_unique<LineCodec>(); };
  sim::Emulator emulator(lines, 0.0);
  Session session(SessionConfig(), 0x47);
  session.opened(0.0);
  for (double now = 0.0; now < 5.0; now += 0.005) {
    const Bytes requests = session.transmit({}, now);
    const Bytes replies = emulator.receive(requests.data(), requests.size(), now);
    session.receive(replies.data(), replies.size(), now);
    ASSERT_FALSE(session.link().isUp());
  }
  EXPECT_NE(session.enable(5.0), "");
}

}  // namespace
}  // namespace laparoscope_servo::aesop
