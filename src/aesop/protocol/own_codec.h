// The wire format between the driver and the controller, version 1: doc/aesop_protocol.md describes it byte by byte. It
// is this project's own: the vendor's is not public.
//
// The decoder takes bytes as they come, in pieces of any length, and finds its way back after garbage.
#pragma once

#include "laparoscope_servo/aesop/codec.h"

namespace laparoscope_servo::aesop {

constexpr std::uint8_t kProtocolVersion = 1;
constexpr std::size_t kFrameOverhead = 9;  // bytes of a frame beside its payload
constexpr std::size_t kLargestPayload = 66;

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

  // Bytes of a frame that is not yet complete: fewer than the longest frame has. All others that were pushed since the
  // last reset are skipped bytes or bytes of frames delivered.
  std::size_t pending() const { return buffer_.size(); }
  const DecoderStatistics& statistics() const { return statistics_; }

 private:
  // Whether the frame at `start` with a right sum is good; counts it.
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
