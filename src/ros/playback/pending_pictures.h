// Finds pictures that were sent to the decoder but were never returned. libav does not report them: it skips pictures
// that cannot be decoded, and a decoder with several threads reports errors with other pictures.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

namespace laparoscope_servo {

class PendingPictures {
 public:
  using Time = std::optional<std::int64_t>;  // presentation time, if the container has one
  struct Sent {
    Time time;
    bool key = false;  // can be decoded without other pictures
  };

  // Call when a picture is sent. Indices increase.
  void sent(std::int64_t index, const Sent& picture) { waiting_[index] = picture; }
  // Call when picture `index`, to be shown at `time`, is returned: returns the missing pictures before it, in their
  // order.
  std::vector<Sent> came(std::int64_t index, Time time);
  // Call at the end: returns all missing pictures.
  std::vector<Sent> end();

 private:
  std::map<std::int64_t, Sent> waiting_;
};

}  // namespace laparoscope_servo
