// The far end of a session, told by the test what to say.
#pragma once

#include <vector>

#include "aesop/protocol/own_codec.h"

namespace laparoscope_servo::aesop {

constexpr std::uint8_t kDrivenMask = 0x47;

class FakeController {
 public:
  // The requests in these bytes; the last sequence number is echoed from then on.
  std::vector<Message> hear(const Bytes& bytes) {
    std::vector<Message> messages;
    for (const Frame& frame : decoder_.push(bytes)) {
      messages.push_back(frame.message);
      status.echo = frame.sequence;
    }
    return messages;
  }
  Bytes identity() { return encode({++sequence_, Identity{7, driven, "fake"}}); }
  Bytes say() {
    status.time += 0.025;
    return encode({++sequence_, status});
  }
  void lose() { ++sequence_; }

  Status status = [] {
    Status s;
    s.homed = true;
    return s;
  }();
  std::uint8_t driven = kDrivenMask;

 private:
  Decoder decoder_;
  std::uint16_t sequence_ = 0;
};

}  // namespace laparoscope_servo::aesop
