#include "laparoscope_servo/ros/decode_compressed.h"

#include <sensor_msgs/Image.h>

#include <exception>
#include <opencv2/imgcodecs.hpp>
#include <stdexcept>

#include "laparoscope_servo/ros/image_conversion.h"
#include "laparoscope_servo/ros/result_messages.h"

namespace laparoscope_servo::skin {

namespace {

constexpr double kThrottle = 5.0;  // s between two lines of the log about the same kind of trouble

sensor_msgs::ImagePtr decoded(const sensor_msgs::CompressedImage& message) {
  if (message.data.empty()) throw std::runtime_error("it is empty");
  const cv::Mat image = cv::imdecode(message.data, cv::IMREAD_UNCHANGED);
  if (image.empty()) throw std::runtime_error("expected JPEG or PNG");
  if (isBayer(message.format) && image.channels() == 1) {
    throw std::runtime_error("it is a colour filter pattern, expected grey or colour");
  }
  return imageMessage(message.header, trackerImage(image));
}

}  // namespace

DecodeCompressed::DecodeCompressed(ros::NodeHandle node)
    : publisher_(node.advertise<sensor_msgs::Image>("image_raw", 50)),
      subscriber_(node.subscribe("compressed", 50, &DecodeCompressed::decode, this)) {}

void DecodeCompressed::decode(const sensor_msgs::CompressedImageConstPtr& message) {
  try {
    publisher_.publish(decoded(*message));
  } catch (const std::exception& error) {
    ROS_ERROR_THROTTLE(kThrottle, "compressed image with format '%s' and %zu bytes is left out: %s",
                       message->format.c_str(), message->data.size(), error.what());
  }
}

}  // namespace laparoscope_servo::skin
