// Node `controller`: see laparoscope_servo/ros/controller_node.h.
#include "laparoscope_servo/ros/controller_node.h"

#include <ros/callback_queue.h>
#include <ros/ros.h>

#include "laparoscope_servo/ros/network_exposure.h"
#include "laparoscope_servo/ros/stop_request.h"
#include "laparoscope_servo/ros/unblocked_output.h"

namespace skin = laparoscope_servo::skin;

int main(int argc, char** argv) {
  const skin::UnblockedOutput output;
  ros::init(argc, argv, "controller", ros::init_options::NoSigintHandler);
  ros::NodeHandle node;
  ros::NodeHandle private_node("~");
  skin::catchStopRequests();

  skin::ParameterReader reader(skin::parametersOf(private_node), private_node.getNamespace());
  skin::ControllerNodeConfig config = skin::controllerNodeConfig(reader);
  if (!reader.errors().empty()) {
    ROS_FATAL("%s", reader.report().c_str());
    return 1;
  }

  skin::resolveNames(config, node);
  skin::ControllerNode controller(node, private_node, config);
  skin::warnOfExposure();
  while (ros::ok() && !skin::stopRequested() && !controller.mustEnd()) {
    ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(0.05));
  }
  controller.stop();
  ros::WallDuration(0.05).sleep();  // publishing is asynchronous: the zeros have to leave before the connections close
  const int status = controller.mustEnd() ? 1 : 0;
  skin::limitFarewell(status);
  ros::shutdown();
  return status;
}
