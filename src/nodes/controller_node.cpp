// Node `controller`: see ros/controller/controller_node.h.
#include "ros/controller/controller_node.h"

#include <ros/ros.h>

#include "nodes/robot_node.h"
#include "ros/common/network_exposure.h"
#include "ros/common/stop_request.h"

using namespace laparoscope_servo;

namespace {

int run() {
  ros::NodeHandle node;
  ros::NodeHandle private_node("~");
  catchStopRequests();

  ParameterReader reader(parametersOf(private_node), private_node.getNamespace());
  ControllerNodeConfig config = controllerNodeConfig(reader);
  if (!reader.errors().empty()) {
    ROS_FATAL("%s", reader.report().c_str());
    return 1;
  }

  resolveNames(config, node);
  ControllerNode controller(node, private_node, config);
  warnOfExposure();
  const int status = controller.run(stopRequested);
  ros::WallDuration(0.05).sleep();  // publishing is asynchronous: the zeros must be sent before the connections close
  limitFarewell(status);
  return status;
}

}  // namespace

int main(int argc, char** argv) {
  return laparoscope_servo::robotNode(argc, argv, "controller", run);
}
