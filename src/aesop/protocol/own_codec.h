// The wire format between the driver and the controller, version 1: doc/aesop_protocol.md describes it byte by byte. It
// is this project's own: the vendor's is not public.
//
// The decoder takes bytes in pieces of any length, and synchronises again after garbage.
#pragma once

#include "laparoscope_servo/aesop/codec.h"

namespace laparoscope_servo::aesop {

constexpr std::uint8_t kProtocolVersion = 1;
constexpr std::size_t kFrameOverhead = 9;  // bytes of a frame beside its payload
constexpr std::size_t kLargestPayload = 66;

// Encodes one frame. Throws std::invalid_argument, naming field and value, when a number is not finite or out of range.
Bytes encode(const Frame& frame);

class Decoder {
 public:
  // Decodes `size` more bytes and returns the frames that they complete, oldest first.
  std::vector<Frame> push(const std::uint8_t* data, std::size_t size);
  std::vector<Frame> push(const Bytes& bytes) { return push(bytes.data(), bytes.size()); }
  // Drops an incomplete frame; the statistics stay.
  void reset() { buffer_.clear(); }

  // Number of bytes of an incomplete frame, less than the longest frame. All other bytes since the last reset were
  // skipped or belong to frames returned.
  std::size_t pending() const { return buffer_.size(); }
  const DecoderStatistics& statistics() const { return statistics_; }

 private:
  // Decodes the frame at `start`, whose check sum is correct, and counts it; false if it is malformed or of another
  // version.
  bool deliver(const std::uint8_t* start, std::vector<Frame>& frames);

  Bytes buffer_;
  DecoderStatistics statistics_;
};

class OwnCodec : public Codec {
 public:
  std::string name() const override;
  std::size_t longestFrame() const override { return kFrameOverhead + kLargestPayload; }
  Bytes encode(const Frame& frame) override { return aesop::encode(frame); }
  std::vector<Frame> push(const std::uint8_t* data, std::size_t size) override { return decoder_.push(data, size); }
  void reset() override { decoder_.reset(); }
  const DecoderStatistics& statistics() const override { return decoder_.statistics(); }

 private:
  Decoder decoder_;
};

}  // namespace laparoscope_servo::aesop
