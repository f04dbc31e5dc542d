#include "ros/tracker/image_intake.h"

namespace laparoscope_servo {

cv::Mat ImageIntake::decode(const sensor_msgs::Image& message) {
  return trackerImage(message, format_, depth());
}

cv::Mat ImageIntake::decode(const cv::Mat& decoded) {
  return trackerImage(decoded, format_, depth());
}

ImageGate::Passed ImageIntake::pass(const ros::Time& stamp, const cv::Mat& image) {
  const ImageGate::Passed passed = gate_.judge(stamp, image.size(), image.channels());
  if (passed.step_back > 0.0) offset_ = time_ + passed.period - stamp.toSec();
  time_ = stamp.toSec() + offset_;
  return passed;
}

}  // namespace laparoscope_servo
