// From the images of a topic or a file to those of one sequence, for every kind of tracker: their pixels as trackers
// take them, which of them continue the sequence, and a time that never goes back.
#pragma once

#include <ros/time.h>
#include <sensor_msgs/Image.h>

#include <opencv2/core.hpp>

#include "laparoscope_servo/tracking/input_config.h"
#include "ros/tracker/image_conversion.h"
#include "ros/tracker/image_gate.h"

namespace laparoscope_servo {

class ImageIntake {
 public:
  // A bit depth of 0 in `format` is estimated from the images.
  ImageIntake(const ImageFormat& format, const tracking::InputConfig& config) : format_(format), gate_(config) {}

  // 8UC1 or 8UC3; may share the data. Throws ImageError, see trackerImage.
  cv::Mat decode(const sensor_msgs::Image& message);
  cv::Mat decode(const cv::Mat& decoded);

  // Checks the next image, and sets the time to it. Throws ImageError, see ImageGate.
  ImageGate::Passed pass(const ros::Time& stamp, const cv::Mat& image);
  // See ImageGate.
  void clockJumpedBack() { gate_.clockJumpedBack(); }

  // s, of the last image that passed: its stamp, as if stamps had never jumped back.
  double time() const { return time_; }

 private:
  BitDepth* depth() { return format_.bit_depth == 0 ? &depth_ : nullptr; }

  ImageFormat format_;
  BitDepth depth_;
  ImageGate gate_;
  double offset_ = 0.0;  // s, from stamps to time_
  double time_ = 0.0;
};

}  // namespace laparoscope_servo
