// Node `controller`: see ros/controller/controller_node.h.
#include "ros/controller/controller_node.h"

#include <ros/callback_queue.h>
#include <ros/ros.h>

#include "ros/common/network_exposure.h"
#include "ros/common/stop_request.h"
#include "ros/common/unblocked_output.h"

using namespace laparoscope_servo;

int main(int argc, char** argv) {
  const UnblockedOutput output;
  ros::init(argc, argv, "controller", ros::init_options::NoSigintHandler);
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
  while (ros::ok() && !stopRequested() && !controller.mustEnd()) {
    ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(0.05));
  }
  controller.stop();
  ros::WallDuration(0.05).sleep();  // publishing is asynchronous: the zeros have to leave before the connections close
  const int status = controller.mustEnd() ? 1 : 0;
  limitFarewell(status);
  ros::shutdown();
  return status;
}
