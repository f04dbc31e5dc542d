// Stands in for a tracker of features and for the camera: publishes what was seen (25 Hz) and camera_info (10 Hz) from
// a thread of its own.
#pragma once

#include <laparoscope_servo/TrackedFeatures.h>
#include <ros/ros.h>
#include <sensor_msgs/CameraInfo.h>

#include <functional>
#include <string>
#include <utility>

#include "repeating_feed.h"

namespace laparoscope_servo {

// What is published; a test changes it.
struct MotionWords {
  bool motion = true;
  bool camera_info = true;
  double stamp_offset = 0.0;  // s, added to the stamps of the motion
  bool without_stamp = false;
  double focal_length = 500.0;  // px, of camera_info
  TrackedFeatures message;
};

// The view is off by (u, v) px.
inline TrackedFeatures viewOff(double u, double v) {
  TrackedFeatures message;
  message.state = TrackedFeatures::TRACKING;
  message.selection_stamp = ros::Time(3);
  TrackedFeature motion;
  motion.id = "view";
  motion.kind = TrackedFeature::MOTION;
  motion.state = TrackedFeatures::TRACKING;
  motion.share = 1.0;
  motion.expected_error = 0.05;
  motion.parameters = {u, v, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
  motion.outline = {u, v, 639.0 + u, v, 639.0 + u, 479.0 + v, u, 479.0 + v};
  TrackedFeature step = motion;
  step.id = "view step";
  message.features = {motion, step};
  return message;
}

// The tip of instrument `number` is seen at (u, v) px.
inline TrackedFeatures tipAt(double u, double v, const std::string& number = "1") {
  TrackedFeatures message;
  message.state = TrackedFeatures::TRACKING;
  message.width = 640;
  message.height = 480;
  TrackedFeature tip;
  tip.id = number + " tip";
  tip.kind = TrackedFeature::POINT;
  tip.state = TrackedFeatures::TRACKING;
  tip.share = 1.0;
  tip.expected_error = 1.0;
  tip.parameters = {u, v};
  message.features = {tip};
  return message;
}

// An object of 60 x 40 px whose middle is at (u, v) px; `selected`: s, the stamp of its selection.
inline TrackedFeatures objectAt(double u, double v, double selected = 3.0) {
  TrackedFeatures message = viewOff(0.0, 0.0);
  message.width = 640;
  message.height = 480;
  message.selection_stamp = ros::Time(selected);
  message.features.resize(1);
  message.features[0].id = "swab";
  message.features[0].outline = {u - 30, v - 20, u + 30, v - 20, u + 30, v + 20, u - 30, v + 20, u - 30, v - 20};
  return message;
}

// Twelve points that are all seen (u, v) px from where they shall be.
inline TrackedFeatures pointsOff(double u, double v) {
  TrackedFeatures message;
  message.state = TrackedFeatures::TRACKING;
  message.width = 640;
  message.height = 480;
  message.selection_stamp = ros::Time(3);
  for (int k = 0; k < 12; ++k) {
    TrackedFeature& point = message.features.emplace_back();
    point.id = "organ " + std::to_string(k + 1);
    point.kind = TrackedFeature::POINT;
    point.state = TrackedFeatures::TRACKING;
    point.share = 1.0;
    point.expected_error = 0.1;
    point.desired = {200.0 + 60.0 * (k % 4), 180.0 + 60.0 * (k / 4)};
    point.parameters = {point.desired[0] + u, point.desired[1] + v};
  }
  return message;
}

class MotionFeed {
 public:
  using Words = MotionWords;

  explicit MotionFeed(const std::string& topic = "/motion_features")
      : motion_(node_.advertise<TrackedFeatures>(topic, 1)) {}
  void end() { repeating_.end(); }
  void set(const std::function<void(MotionWords&)>& change) { repeating_.set(change); }

 private:
  void publish(MotionWords words, int k) {
    if (words.motion) {
      words.message.header.stamp = stampNow(words);
      // No two pictures are the same.
      if (!words.message.features.empty()) {
        TrackedFeature& first = words.message.features[0];
        first.parameters[0] += 1e-9 * k;
        if (!first.outline.empty()) first.outline[0] += 1e-9 * k;
      }
      motion_.publish(words.message);
    }
    if (words.camera_info && k % 3 == 0) {
      sensor_msgs::CameraInfo info;
      info.header.stamp = ros::Time::now();
      info.width = 640;
      info.height = 480;
      info.distortion_model = "plumb_bob";
      info.D.assign(5, 0.0);
      const double f = words.focal_length;
      info.K = {f, 0.0, 319.5, 0.0, f, 239.5, 0.0, 0.0, 1.0};
      info.P = {f, 0.0, 319.5, 0.0, 0.0, f, 239.5, 0.0, 0.0, 0.0, 1.0, 0.0};
      camera_info_.publish(info);
    }
  }

  ros::NodeHandle node_;
  ros::Publisher motion_;
  ros::Publisher camera_info_ = node_.advertise<sensor_msgs::CameraInfo>("/camera_info", 1);
  RepeatingFeed<MotionWords> repeating_{
      [this](MotionWords words, int k) { publish(std::move(words), k); }};  // ends before the rest does
};

}  // namespace laparoscope_servo
