// Stands in for the tracker's homography: publishes what was seen (25 Hz) from a thread of its own.
#pragma once

#include <laparoscope_servo/Homography.h>
#include <ros/ros.h>

#include <atomic>
#include <chrono>
#include <functional>
#include <mutex>
#include <thread>

namespace laparoscope_servo {

// What is published; a test changes it.
struct PositionWords {
  bool speaks = true;
  double stamp_offset = 0.0;  // s, added to the stamps
  bool without_stamp = false;
  Homography message;
};

// The region is seen (x, y) from where it shall be, normalised; it was selected at 3 s.
inline Homography regionOff(double x, double y) {
  Homography message;
  message.state = Homography::TRACKING;
  message.reference_stamp = ros::Time(3);
  message.has_intrinsics = 1;
  message.h = {1.0, 0.0, x, 0.0, 1.0, y, 0.0, 0.0, 1.0};
  message.visible_fraction = 1.0;
  message.corner_error = 0.1;
  return message;
}

class HomographyFeed {
 public:
  HomographyFeed() : publisher_([this] { publishUntilEnd(); }) {}
  ~HomographyFeed() { end(); }
  void end() {
    end_ = true;
    if (publisher_.joinable()) publisher_.join();
  }
  void set(const std::function<void(PositionWords&)>& change) {
    const std::lock_guard<std::mutex> lock(mutex_);
    change(words_);
  }

 private:
  void publishUntilEnd() {
    for (int k = 0; !end_; ++k) {
      PositionWords words;
      {
        const std::lock_guard<std::mutex> lock(mutex_);
        words = words_;
      }
      if (words.speaks) {
        words.message.header.stamp = ros::Time::now() + ros::Duration(words.stamp_offset);
        if (words.without_stamp) words.message.header.stamp = ros::Time();
        words.message.h[2] += 1e-9 * k;  // no two pictures are the same
        homography_.publish(words.message);
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(40));
    }
  }

  ros::NodeHandle node_;
  ros::Publisher homography_ = node_.advertise<Homography>("/homography", 1);
  std::mutex mutex_;
  PositionWords words_;
  std::atomic<bool> end_{false};
  std::thread publisher_;
};

}  // namespace laparoscope_servo
