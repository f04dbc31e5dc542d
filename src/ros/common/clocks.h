// The two clocks of a node: ages are measured on the steady one; stamps are compared with ROS time, which may be
// simulated, stop or jump.
#pragma once

#include <ros/time.h>
#include <time.h>

namespace laparoscope_servo {

// s since an arbitrary moment; includes the time for which the machine sleeps, so that no data looks fresh after it.
inline double steadyNow() {
  timespec time{};
  ::clock_gettime(CLOCK_BOOTTIME, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

// s
inline double stampNow() {
  return ros::Time::now().toSec();
}

}  // namespace laparoscope_servo
