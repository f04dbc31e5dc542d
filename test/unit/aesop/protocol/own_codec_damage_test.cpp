// What the decoder makes of bytes that are no frames.
#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "aesop/protocol/own_codec.h"
#include "unit/aesop/messages.h"

namespace laparoscope_servo::aesop {
namespace {

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

TEST(CodecDamage, sumIsCcittFalse) {
  const Bytes check = {'1', '2', '3', '4', '5', '6', '7', '8', '9'};
  EXPECT_EQ(crcBitwise(check, 0), 0x29B1);  // the check value of its definition
  EXPECT_EQ(frameOf(1, 0x06, {}), encode({7, Poll()}));
}

Bytes changed(Bytes bytes, std::size_t at, std::uint8_t value) {
  bytes[at] = value;
  return bytes;
}

TEST(CodecDamage, malformedFramesAreCountedAndNotDelivered) {
  const Bytes velocity = changed(Bytes(18, 0), 0, 200);
  const Bytes status(66, 0);
  const Bytes identity(18, 0);
  ASSERT_EQ(Decoder().push(frameOf(1, 0x07, velocity)).size(), 1u);
  ASSERT_EQ(Decoder().push(frameOf(1, 0x82, status)).size(), 1u);
  ASSERT_EQ(Decoder().push(frameOf(1, 0x81, identity)).size(), 1u);
  const std::vector<Bytes> malformed = {
      frameOf(1, 0x07, changed(velocity, 0, 0)),     // no time to live
      frameOf(1, 0x07, changed(velocity, 1, 0x10)),  // one that is too long
      frameOf(1, 0x07, changed(velocity, 5, 0x7F)),  // a speed of 2130 m/s
      frameOf(1, 0x07, changed(velocity, 5, 0x80)),  // and of -2147
      frameOf(1, 0x07, Bytes(17, 1)),
      frameOf(1, 0x07, Bytes(19, 1)),
      frameOf(1, 0x82, changed(status, 0, 3)),  // a state that is none
      frameOf(1, 0x82, changed(status, 1, 4)),  // a flag that is none
      frameOf(1, 0x82, changed(status, 65, 0x80)),
      frameOf(1, 0x82, Bytes(65, 0)),
      frameOf(1, 0x81, changed(identity, 2, 0x07)),  // not printable
      frameOf(1, 0x81, changed(identity, 10, 'x')),  // after the end
      frameOf(1, 0x02, Bytes(1, 0)),
      frameOf(1, 0x00, {}),
      frameOf(1, 0x83, {}),
  };
  for (const Bytes& bytes : malformed) {
    Decoder decoder;
    EXPECT_TRUE(decoder.push(bytes).empty());
    EXPECT_EQ(decoder.statistics().malformed, 1u);
    EXPECT_EQ(decoder.statistics().skipped_bytes, bytes.size());
    EXPECT_EQ(decoder.push(encode({1, Poll()})).size(), 1u);
  }
}

TEST(CodecDamage, otherVersionIsCountedAndNotDelivered) {
  Decoder decoder;
  EXPECT_TRUE(decoder.push(frameOf(2, 0x06, {})).empty());
  EXPECT_EQ(decoder.statistics().other_version, 1u);
  EXPECT_EQ(decoder.statistics().malformed, 0u);
}

TEST(CodecDamage, bytesOneByOne) {
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

TEST(CodecDamage, findsItsWayBackAfterGarbage) {
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

TEST(CodecDamage, everyFlippedBitIsFound) {
  const Bytes good = encode({5, Velocity{{0.01, 0.02, 0.03, 0.04}, 0.1}});
  for (std::size_t bit = 0; bit < 8 * good.size(); ++bit) {
    Bytes bad = good;
    bad[bit / 8] = static_cast<std::uint8_t>(bad[bit / 8] ^ (1u << (bit % 8)));
    EXPECT_TRUE(Decoder().push(bad).empty()) << "bit " << bit;
  }
}

TEST(CodecDamage, lostAndDoubledBytesAreFound) {
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

TEST(CodecDamage, randomBytesMakeNoFrameAndNoGrowth) {
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

}  // namespace
}  // namespace laparoscope_servo::aesop
