// The node `decode_compressed`: turns sensor_msgs/CompressedImage into sensor_msgs/Image where image_transport's plugin
// for it is not installed (Debian has none).
//
// Subscribes: compressed (sensor_msgs/CompressedImage). Publishes: image_raw (sensor_msgs/Image, same header).
#pragma once

#include <ros/ros.h>
#include <sensor_msgs/CompressedImage.h>

namespace laparoscope_servo::skin {

class DecodeCompressed {
 public:
  explicit DecodeCompressed(ros::NodeHandle node);

 private:
  void decode(const sensor_msgs::CompressedImageConstPtr& message);

  ros::Publisher publisher_;
  ros::Subscriber subscriber_;
};

}  // namespace laparoscope_servo::skin
