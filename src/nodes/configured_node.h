// The main program of a node that needs only its parameters to start.
#pragma once

#include <ros/ros.h>

#include <cstdlib>
#include <exception>

#include "ros/common/parameters.h"
#include "ros/common/unblocked_output.h"

namespace laparoscope_servo {

// Returns the exit status: 0 after run(node, private_node, config); 1 with a message if the private parameters are
// refused, or if `run` throws.
template <class Config, class Run>
int configuredNode(int argc, char** argv, const char* name, const Run& run) {
  const UnblockedOutput output;
  ros::init(argc, argv, name);
  ros::NodeHandle node;
  ros::NodeHandle private_node("~");
  ParameterReader reader(parametersOf(private_node), private_node.getNamespace());
  Config config;
  reader.readAll(config);
  if (!reader.errors().empty()) {
    ROS_FATAL("%s", reader.report().c_str());
    return EXIT_FAILURE;
  }
  try {
    run(node, private_node, config);
  } catch (const std::exception& error) {
    ROS_FATAL("%s", error.what());
    return EXIT_FAILURE;
  }
  return EXIT_SUCCESS;
}

}  // namespace laparoscope_servo
