// Node `joystick`: see ros/joystick/joystick_node.h.
#include "ros/joystick/joystick_node.h"

#include "nodes/configured_node.h"
#include "ros/common/network_exposure.h"

using namespace laparoscope_servo;

int main(int argc, char** argv) {
  const auto run = [](ros::NodeHandle& node, ros::NodeHandle& private_node, JoystickNodeConfig& config) {
    JoystickNode joystick(node, private_node, config);
    warnOfExposure();
    joystick.run();
  };
  return configuredNode<JoystickNodeConfig>(argc, argv, "joystick", run);
}
