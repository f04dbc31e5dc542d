// The two clocks of a node: ages are measured on the steady one, stamps are compared with ROS time, which may be
// simulated, stand or jump.
#pragma once

#include <ros/time.h>

#include <chrono>

namespace laparoscope_servo::skin {

// s since an arbitrary moment.
inline double steadyNow() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

// s
inline double stampNow() {
  return ros::Time::now().toSec();
}

}  // namespace laparoscope_servo::skin
