// Node `simulated_camera`: see laparoscope_servo/ros/simulated_camera.h.
#include <ros/ros.h>

#include <cstdlib>
#include <exception>

#include "laparoscope_servo/ros/frame_names.h"
#include "laparoscope_servo/ros/simulated_camera.h"

namespace skin = laparoscope_servo::skin;

int main(int argc, char** argv) {
  ros::init(argc, argv, "simulated_camera");
  ros::NodeHandle node;
  ros::NodeHandle private_node("~");
  skin::ParameterReader reader(skin::parametersOf(private_node), private_node.getNamespace());
  skin::SimulatedCameraConfig config = skin::simulatedCameraConfig(reader);
  if (!reader.errors().empty()) {
    ROS_FATAL("%s", reader.report().c_str());
    return EXIT_FAILURE;
  }
  const std::string prefix = skin::framePrefix(config.frame_prefix, node.getNamespace());
  config.frame_id = skin::prefixedFrame(prefix, config.frame_id);
  config.base_frame = skin::prefixedFrame(prefix, config.base_frame);
  try {
    skin::SimulatedCamera(node, private_node, config).run();
  } catch (const std::exception& error) {
    ROS_FATAL("%s", error.what());
    return EXIT_FAILURE;
  }
  return EXIT_SUCCESS;
}
