// The main program of a node that the arm depends on.
#pragma once

#include <ros/ros.h>

#include <exception>

#include "ros/common/unblocked_output.h"

namespace laparoscope_servo {

// Returns the exit status: that of `run`, or 1 with a message if it throws. Does not install ROS' signal handler, so
// that the node can stop the arm before it ends.
inline int robotNode(int argc, char** argv, const char* name, int (*run)()) {
  const UnblockedOutput output;
  ros::init(argc, argv, name, ros::init_options::NoSigintHandler);
  int status = 1;
  try {
    status = run();
  } catch (const std::exception& error) {
    ROS_FATAL_STREAM(error.what());
  }
  ros::shutdown();
  return status;
}

}  // namespace laparoscope_servo
