// Interface for wire formats. Everything above it uses Frames; only a codec knows bytes. A new format (such as the
// vendor's) is one class and a line in the table of codec.cpp: doc/aesop_protocol.md, "Another codec".
//
// Pure: no clock, no port. Each end of a line has a codec of its own, which may keep a state about what it has sent and
// received.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "laparoscope_servo/aesop/messages.h"

namespace laparoscope_servo::aesop {

using Bytes = std::vector<std::uint8_t>;

struct Frame {
  std::uint16_t sequence = 0;
  Message message;
};

struct DecoderStatistics {
  std::uint64_t frames = 0;         // delivered
  std::uint64_t skipped_bytes = 0;  // bytes that belong to no good frame
  std::uint64_t crc_errors = 0;
  std::uint64_t malformed = 0;      // frames with a correct check sum, but an undefined length, type or value
  std::uint64_t other_version = 0;  // frames with a correct check sum, but another version of the format
  unsigned version_heard = 0;       // version of the last of those
};

class Codec {
 public:
  virtual ~Codec() = default;

  // Format and version in a few words, for texts to the user.
  virtual std::string name() const = 0;
  // Bytes of the longest frame, for estimates of the load of the line.
  virtual std::size_t longestFrame() const = 0;
  // Encodes one frame. Throws std::invalid_argument, naming field and value, when the format cannot carry it.
  virtual Bytes encode(const Frame& frame) = 0;
  // Decodes `size` more bytes and returns the frames that they complete, oldest first. Accepts any bytes, in pieces of
  // any length, and throws nothing.
  virtual std::vector<Frame> push(const std::uint8_t* data, std::size_t size) = 0;
  // Drops an incomplete frame, for a new line. The statistics stay.
  virtual void reset() = 0;
  virtual const DecoderStatistics& statistics() const = 0;
};

using CodecFactory = std::function<std::unique_ptr<Codec>()>;

// This project's own format, own_codec.h.
std::unique_ptr<Codec> makeOwnCodec();

// Names of the codecs for configurations, e.g. "own".
std::vector<std::string> codecNames();
// Throws std::invalid_argument that lists the known names.
CodecFactory codecNamed(const std::string& name);

// -1, 0 or 1: whether sequence number `a` is older than, equal to or newer than `b`, counting modulo 65536.
int compareSequence(std::uint16_t a, std::uint16_t b);

}  // namespace laparoscope_servo::aesop
