// Publishes what was seen at 25 Hz from a thread of its own, until it is told to end; a test changes what that is.
#pragma once

#include <ros/time.h>

#include <atomic>
#include <chrono>
#include <functional>
#include <mutex>
#include <thread>
#include <utility>

namespace laparoscope_servo {

template <typename Words>
class RepeatingFeed {
 public:
  // `publish`: what to do with the words of picture `k`.
  explicit RepeatingFeed(std::function<void(Words words, int k)> publish)
      : publish_(std::move(publish)), thread_([this] { publishUntilEnd(); }) {}
  ~RepeatingFeed() { end(); }
  void end() {
    end_ = true;
    if (thread_.joinable()) thread_.join();
  }
  void set(const std::function<void(Words&)>& change) {
    const std::lock_guard<std::mutex> lock(mutex_);
    change(words_);
  }

 private:
  void publishUntilEnd() {
    for (int k = 0; !end_; ++k) {
      Words words;
      {
        const std::lock_guard<std::mutex> lock(mutex_);
        words = words_;
      }
      publish_(std::move(words), k);
      std::this_thread::sleep_for(std::chrono::milliseconds(40));
    }
  }

  std::function<void(Words, int)> publish_;
  std::mutex mutex_;
  Words words_;
  std::atomic<bool> end_{false};
  std::thread thread_;
};

// Of a picture that is seen now, with the faults of its stamp that the words tell.
template <typename Words>
ros::Time stampNow(const Words& words) {
  return words.without_stamp ? ros::Time() : ros::Time::now() + ros::Duration(words.stamp_offset);
}

}  // namespace laparoscope_servo
