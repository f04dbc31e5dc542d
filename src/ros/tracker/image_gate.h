// Which images are the next ones: by their stamps and sizes alone, before anything looks at their pixels.
//
// One image that is out of order, repeated, without a stamp, far ahead, or of another size is refused: nobody can tell
// what it shows. Only when several come in a row that agree with each other is it another time, or another camera.
#pragma once

#include <ros/time.h>

#include <opencv2/core.hpp>
#include <string>

#include "laparoscope_servo/tracking/input_config.h"

namespace laparoscope_servo {

class ImageGate {
 public:
  // What an image that is taken means for those that follow.
  struct Passed {
    double step_back = 0.0;   // s, > 0: time begins again, so much earlier
    bool loop = false;        // the step is one of a recording that begins again
    bool other_size = false;  // another camera
    double period = 0.0;      // s since the image before; after a step, the last one that was known
  };

  explicit ImageGate(const tracking::InputConfig& config) : config_(config) {}

  // The next image, of `size` and `channels`. Throws ImageError, with the cause kStamp or kSize, when it is refused.
  Passed judge(const ros::Time& stamp, const cv::Size& size, int channels);

  // The clock that the stamps come from has jumped back: the next image behind the last one is believed at once.
  void clockJumpedBack() { clock_jumps_ = kJumpLasts; }

 private:
  static constexpr int kJumpLasts = 50;  // images: those that were on their way when the clock jumped come first

  bool otherSize(const cv::Size& size, int channels);
  void passTime(const ros::Time& stamp, Passed& passed);

  tracking::InputConfig config_;
  bool empty_ = true;
  ros::Time last_;
  double period_ = 0.04;  // s; until two images are known it only keeps time going on
  int clock_jumps_ = 0;
  // Another time, or another size, that waits for being confirmed.
  ros::Time other_last_;
  int other_times_ = 0;
  cv::Size size_;
  int channels_ = 0;
  cv::Size other_size_;
  int other_channels_ = 0;
  int other_sizes_ = 0;
};

// Throws ImageError when the stamp is zero, or further ahead of `now` than `max_ahead` [s]. A `now` of zero is a clock
// that has not started, or of which nothing can be said.
void checkStamp(const ros::Time& stamp, const ros::Time& now, double max_ahead);

}  // namespace laparoscope_servo
