// Node `simulated_camera`: see ros/simulation/simulated_camera.h.
#include <ros/ros.h>

#include <cstdlib>
#include <exception>

#include "ros/aesop/aesop_parameters.h"
#include "ros/common/frame_names.h"
#include "ros/common/parameters.h"
#include "ros/simulation/simulated_camera.h"

using namespace laparoscope_servo;

int main(int argc, char** argv) {
  ros::init(argc, argv, "simulated_camera");
  ros::NodeHandle node;
  ros::NodeHandle private_node("~");
  ParameterReader reader(parametersOf(private_node), private_node.getNamespace());
  // One file may describe the arm for both ends.
  AesopParameters arm;
  parameters::Table of_the_arm;
  describe(of_the_arm, arm);
  reader.allow(of_the_arm);
  SimulatedCameraConfig config;
  reader.readAll(config);
  if (!reader.errors().empty()) {
    ROS_FATAL("%s", reader.report().c_str());
    return EXIT_FAILURE;
  }
  const std::string prefix = framePrefix(config.frame_prefix, node.getNamespace());
  config.frame_id = prefixedFrame(prefix, config.frame_id);
  config.base_frame = prefixedFrame(prefix, config.base_frame);
  try {
    SimulatedCamera(node, private_node, config).run();
  } catch (const std::exception& error) {
    ROS_FATAL("%s", error.what());
    return EXIT_FAILURE;
  }
  return EXIT_SUCCESS;
}
