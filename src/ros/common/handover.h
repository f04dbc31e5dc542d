// Hands the newest value from one thread to another, which never waits for it.
#pragma once

#include <mutex>
#include <utility>

namespace laparoscope_servo {

template <class T>
class Handover {
 public:
  void give(const T& value) {
    T copy = value;  // what is long is done before anybody is locked out
    const std::lock_guard<std::mutex> lock(mutex_);
    std::swap(value_, copy);
    fresh_ = true;
  }

  // Takes what was given since the last time. Neither waits nor allocates: false when there is nothing, or while
  // something is just being given.
  bool take(T& value) {
    const std::unique_lock<std::mutex> lock(mutex_, std::try_to_lock);
    if (!lock || !fresh_) return false;
    std::swap(value_, value);
    fresh_ = false;
    return true;
  }

 private:
  std::mutex mutex_;
  T value_;
  bool fresh_ = false;
};

}  // namespace laparoscope_servo
