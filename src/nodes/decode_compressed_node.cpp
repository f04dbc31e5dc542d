// Node `decode_compressed`: see laparoscope_servo/ros/decode_compressed.h.
#include <ros/ros.h>

#include "laparoscope_servo/ros/decode_compressed.h"

int main(int argc, char** argv) {
  ros::init(argc, argv, "decode_compressed");
  const laparoscope_servo::skin::DecodeCompressed node{ros::NodeHandle()};
  ros::spin();
  return 0;
}
