// Decides by stamp and size alone which images continue the sequence, before any pixel is processed.
//
// A single image that is out of order, repeated, without a stamp, far ahead, or of another size is refused. Several in
// a row that agree with each other mean another time or another camera, and are accepted.
#pragma once

#include <ros/time.h>

#include <opencv2/core.hpp>
#include <string>

#include "laparoscope_servo/tracking/input_config.h"

namespace laparoscope_servo {

class ImageGate {
 public:
  // Result for an accepted image.
  struct Passed {
    double step_back = 0.0;   // s, > 0: time jumped back by this
    bool loop = false;        // the step is that of a recording that begins again
    bool other_size = false;  // another camera
    double period = 0.0;      // s since the last image; after a step, the last known period
  };

  explicit ImageGate(const tracking::InputConfig& config) : config_(config) {}

  // Checks the next image, of `size` and `channels`. Throws ImageError, with cause kStamp or kSize, if it is refused.
  Passed judge(const ros::Time& stamp, const cv::Size& size, int channels);

  // Call if the clock of the stamps has jumped back: the next image with an earlier stamp is accepted at once.
  void clockJumpedBack() { clock_jumps_ = kJumpLasts; }

 private:
  // images for which this holds, since those under way when the clock jumped come first
  static constexpr int kJumpLasts = 50;

  bool otherSize(const cv::Size& size, int channels);
  void passTime(const ros::Time& stamp, Passed& passed);

  tracking::InputConfig config_;
  bool empty_ = true;
  ros::Time last_;
  double period_ = 0.04;  // s; the initial value is used until there are two images
  int clock_jumps_ = 0;
  // A new time or size that is not confirmed yet.
  ros::Time other_last_;
  int other_times_ = 0;
  cv::Size size_;
  int channels_ = 0;
  cv::Size other_size_;
  int other_channels_ = 0;
  int other_sizes_ = 0;
};

// Throws ImageError when the stamp is zero, or further ahead of `now` than `max_ahead` [s]. A `now` of zero is a clock
// that has not started or is not known; nothing is then ahead.
void checkStamp(const ros::Time& stamp, const ros::Time& now, double max_ahead);

}  // namespace laparoscope_servo
