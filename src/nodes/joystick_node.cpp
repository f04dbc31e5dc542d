// Node `joystick`: see ros/joystick/joystick_node.h.
#include "ros/joystick/joystick_node.h"

#include <ros/ros.h>

#include <cstdlib>

#include "ros/common/network_exposure.h"
#include "ros/common/parameters.h"
#include "ros/common/unblocked_output.h"

using namespace laparoscope_servo;

int main(int argc, char** argv) {
  const UnblockedOutput output;
  ros::init(argc, argv, "joystick");
  ros::NodeHandle node;
  ros::NodeHandle private_node("~");
  ParameterReader reader(parametersOf(private_node), private_node.getNamespace());
  JoystickNodeConfig config;
  reader.readAll(config);
  if (!reader.errors().empty()) {
    ROS_FATAL("%s", reader.report().c_str());
    return EXIT_FAILURE;
  }
  JoystickNode joystick(node, private_node, config);
  warnOfExposure();
  joystick.run();
  return EXIT_SUCCESS;
}
