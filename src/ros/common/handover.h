// Passes the newest value from one thread to another, which never waits.
#pragma once

#include <mutex>
#include <utility>

namespace laparoscope_servo {

template <class T>
class Handover {
 public:
  void give(const T& value) {
    T copy = value;  // copies before locking, so that the lock is short
    const std::lock_guard<std::mutex> lock(mutex_);
    std::swap(value_, copy);
    fresh_ = true;
  }

  // Takes the value given since the last call. Does not wait nor allocate: returns false if there is none, or while one
  // is being given.
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
