// Node `recorder`: see ros/recording/recorder.h.
#include <ros/ros.h>

#include <cstdlib>
#include <exception>

#include "ros/common/network_exposure.h"
#include "ros/common/parameters.h"
#include "ros/common/unblocked_output.h"
#include "ros/recording/recorder.h"

using namespace laparoscope_servo;

int main(int argc, char** argv) {
  const UnblockedOutput output;
  ros::init(argc, argv, "recorder");
  ros::NodeHandle node;
  ros::NodeHandle private_node("~");
  ParameterReader reader(parametersOf(private_node), private_node.getNamespace());
  RecorderConfig config;
  reader.readAll(config);
  if (!reader.errors().empty()) {
    ROS_FATAL("%s", reader.report().c_str());
    return EXIT_FAILURE;
  }
  try {
    const Recorder recorder(node, private_node, config);
    warnOfExposure();
    ros::spin();
  } catch (const std::exception& error) {
    ROS_FATAL("%s", error.what());
    return EXIT_FAILURE;
  }
  return EXIT_SUCCESS;
}
