// Which pictures of a video went into the decoder and never came out of it. libav has no word for that: what cannot be
// decoded is left out, and a decoder that runs in several threads tells an error with another picture's turn.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

namespace laparoscope_servo {

class PendingPictures {
 public:
  using Time = std::optional<std::int64_t>;  // of presentation, where the container has one
  struct Sent {
    Time time;
    bool key = false;  // it needs no other picture
  };

  // Indices count up with each picture that goes in.
  void sent(std::int64_t index, const Sent& picture) { waiting_[index] = picture; }
  // Picture `index` came out, which is to be shown at `time`: those that should have come before it, in their order.
  std::vector<Sent> came(std::int64_t index, Time time);
  // Nothing comes any more: what is missing.
  std::vector<Sent> end();

 private:
  std::map<std::int64_t, Sent> waiting_;
};

}  // namespace laparoscope_servo
