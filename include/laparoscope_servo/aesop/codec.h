// The wire format between the driver and the controller: doc/aesop_protocol.md describes it byte by byte. It is this
// project's own: the vendor's is not public. Who has the vendor's manual replaces this file and its source, and nothing
// else.
//
// Pure: no clock, no port. The decoder takes bytes as they come, in pieces of any length, and finds its way back after
// garbage.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "laparoscope_servo/aesop/messages.h"

namespace laparoscope_servo::aesop {

using Bytes = std::vector<std::uint8_t>;

constexpr std::uint8_t kProtocolVersion = 1;
constexpr std::size_t kFrameOverhead = 9;  // bytes of a frame beside its payload
constexpr std::size_t kLargestPayload = 66;
constexpr double kLargestNumber = 2000.0;  // of positions and velocities, m or rad (a second), either sign

struct Frame {
  std::uint16_t sequence = 0;
  Message message;
};

struct DecoderStatistics {
  std::uint64_t frames = 0;         // delivered
  std::uint64_t skipped_bytes = 0;  // that belonged to no good frame
  std::uint64_t crc_errors = 0;
  std::uint64_t malformed = 0;      // CRC right, but a length, type or value that the format does not have
  std::uint64_t other_version = 0;  // CRC right, but another version of the protocol
};

// The bytes of one frame. Throws std::invalid_argument, naming field and value, when a number is not finite or out of
// range.
Bytes encode(const Frame& frame);

class Decoder {
 public:
  // The frames that `size` more bytes complete, oldest first.
  std::vector<Frame> push(const std::uint8_t* data, std::size_t size);
  std::vector<Frame> push(const Bytes& bytes) { return push(bytes.data(), bytes.size()); }
  // Forgets a frame that is not yet complete; the statistics stay.
  void reset() { buffer_.clear(); }

  const DecoderStatistics& statistics() const { return statistics_; }

 private:
  Bytes buffer_;
  DecoderStatistics statistics_;
};

// -1, 0 or 1: whether sequence number `a` is older than, equal to or newer than `b`, counting modulo 65536.
int compareSequence(std::uint16_t a, std::uint16_t b);

}  // namespace laparoscope_servo::aesop
