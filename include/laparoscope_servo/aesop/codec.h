// The place where another wire format plugs in. Everything above speaks in Frames; only a codec knows bytes. Who has
// the vendor's manual writes one class and adds a line to the table in codec.cpp: doc/aesop_protocol.md, "Another
// codec".
//
// Pure: no clock, no port. Each end of a line has a codec of its own, which may remember what it has said and heard.
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
  std::uint64_t skipped_bytes = 0;  // that belonged to no good frame
  std::uint64_t crc_errors = 0;
  std::uint64_t malformed = 0;      // check sum right, but a length, type or value that the format does not have
  std::uint64_t other_version = 0;  // check sum right, but another version of the format
  unsigned version_heard = 0;       // of those, the last one's
};

class Codec {
 public:
  virtual ~Codec() = default;

  // Format and version in a few words, for messages to people.
  virtual std::string name() const = 0;
  // Bytes; what the line has to carry for one status.
  virtual std::size_t longestFrame() const = 0;
  // The bytes of one frame. Throws std::invalid_argument, naming field and value, when the format cannot carry it.
  virtual Bytes encode(const Frame& frame) = 0;
  // The frames that `size` more bytes complete, oldest first. Takes anything, in pieces of any length, and throws
  // nothing.
  virtual std::vector<Frame> push(const std::uint8_t* data, std::size_t size) = 0;
  // Forgets a frame that is not yet complete: the line is a new one. The statistics stay.
  virtual void reset() = 0;
  virtual const DecoderStatistics& statistics() const = 0;
};

using CodecFactory = std::function<std::unique_ptr<Codec>()>;

// This project's own format, own_codec.h.
std::unique_ptr<Codec> makeOwnCodec();

// The codecs that configurations can name, e.g. "own".
std::vector<std::string> codecNames();
// Throws std::invalid_argument that lists the names there are.
CodecFactory codecNamed(const std::string& name);

// -1, 0 or 1: whether sequence number `a` is older than, equal to or newer than `b`, counting modulo 65536.
int compareSequence(std::uint16_t a, std::uint16_t b);

}  // namespace laparoscope_servo::aesop
