#include "ros/tracker/image_gate.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "ros/tracker/image_conversion.h"

namespace laparoscope_servo {

namespace {

template <typename... Parts>
[[noreturn]] void refuse(Refusal cause, const Parts&... parts) {
  std::ostringstream text;
  text.precision(6);
  (text << ... << parts);
  throw ImageError(text.str(), cause);
}

std::string kind(const cv::Size& size, int channels) {
  std::ostringstream text;
  text << size.width << "x" << size.height << (channels == 1 ? " px, grey" : " px, in colour");
  return text.str();
}

}  // namespace

ImageGate::Passed ImageGate::judge(const ros::Time& stamp, const cv::Size& size, int channels) {
  Passed passed;
  // Checks the size first, since the stamp of an image of another size is not used.
  passed.other_size = !empty_ && otherSize(size, channels);
  if (passed.other_size) {
    const double step = (last_ - stamp).toSec();
    passed.step_back = std::max(0.0, step);
    passed.loop = step > config_.loop_step;
    passed.period = period_;
    other_times_ = 0;
  } else if (!empty_) {
    passTime(stamp, passed);
  }
  empty_ = false;
  last_ = stamp;
  size_ = size;
  channels_ = channels;
  other_sizes_ = 0;
  return passed;
}

bool ImageGate::otherSize(const cv::Size& size, int channels) {
  if (size == size_ && channels == channels_) return false;
  other_sizes_ = size == other_size_ && channels == other_channels_ ? other_sizes_ + 1 : 1;
  other_size_ = size;
  other_channels_ = channels;
  if (other_sizes_ >= config_.restart_images) return true;
  refuse(Refusal::kSize, "the image has ", kind(size, channels), ", those before ", kind(size_, channels_),
         ": another camera is believed after ", config_.restart_images, " in a row (parameter input/restart_images)");
}

void ImageGate::passTime(const ros::Time& stamp, Passed& passed) {
  const double step = (stamp - last_).toSec();
  passed.period = period_;
  if (step > 0.0 && step <= config_.max_gap) {
    period_ = passed.period = step;
    other_times_ = 0;
    return;
  }
  if (stamp.isZero()) refuse(Refusal::kStamp, "the image has a stamp of zero: does the driver stamp its images?");
  if (step == 0.0) refuse(Refusal::kStamp, "the image repeats the stamp of the one before");
  const double on = (stamp - other_last_).toSec();
  const bool goes_on = other_times_ > 0 && on > 0.0 && on <= config_.max_gap;
  other_times_ = goes_on ? other_times_ + 1 : 1;
  other_last_ = stamp;
  // A step ahead is usually a pause, and one more image suffices to distinguish it from a single wrong stamp.
  const int needed = step > 0.0 ? 2 : clock_jumps_ > 0 ? 1 : config_.restart_images;
  clock_jumps_ = std::max(0, clock_jumps_ - 1);
  if (other_times_ < needed) {
    refuse(Refusal::kStamp, "the image is stamped ", std::abs(step), step > 0.0 ? " s after" : " s before",
           " the one before it: that time is believed after ", needed, " in a row");
  }
  other_times_ = 0;
  if (step > 0.0) {
    passed.period = step;
    return;
  }
  clock_jumps_ = 0;
  passed.step_back = -step;
  passed.loop = -step > config_.loop_step;
}

void checkStamp(const ros::Time& stamp, const ros::Time& now, double max_ahead) {
  if (stamp.isZero()) {
    refuse(Refusal::kStamp, "the image has a stamp of zero: the driver has to stamp its images, nobody could tell how ",
           "old they are");
  }
  if (now.isZero()) return;
  const double ahead = (stamp - now).toSec();
  if (ahead > max_ahead) {
    refuse(Refusal::kStamp, "the image is stamped ", ahead, " s ahead of this machine's clock, expected at most ",
           max_ahead, " s (parameter input/max_ahead)");
  }
}

}  // namespace laparoscope_servo
