// Headers of images for tests.
#pragma once

#include <std_msgs/Header.h>

namespace laparoscope_servo::test_support {

// stamp: s.
inline std_msgs::Header at(double stamp) {
  std_msgs::Header header;
  header.stamp = ros::Time(stamp);
  header.frame_id = "optical";
  return header;
}

}  // namespace laparoscope_servo::test_support
