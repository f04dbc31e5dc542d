// Stands in for the tracker's homography: publishes what was seen (25 Hz) from a thread of its own.
#pragma once

#include <laparoscope_servo/Homography.h>
#include <ros/ros.h>

#include <functional>
#include <string>
#include <utility>

#include "repeating_feed.h"

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
  using Words = PositionWords;

  explicit HomographyFeed(const std::string& topic) : homography_(node_.advertise<Homography>(topic, 1)) {}
  void end() { repeating_.end(); }
  void set(const std::function<void(PositionWords&)>& change) { repeating_.set(change); }

 private:
  void publish(PositionWords words, int k) {
    if (!words.speaks) return;
    words.message.header.stamp = stampNow(words);
    words.message.h[2] += 1e-9 * k;  // no two pictures are the same
    homography_.publish(words.message);
  }

  ros::NodeHandle node_;
  ros::Publisher homography_;
  RepeatingFeed<PositionWords> repeating_{
      [this](PositionWords words, int k) { publish(std::move(words), k); }};  // ends before the rest does
};

}  // namespace laparoscope_servo
