// Node `camera`: see ros/camera/camera_driver.h.
#include "nodes/configured_node.h"
#include "ros/camera/camera_driver.h"
#include "ros/common/network_exposure.h"

using namespace laparoscope_servo;

int main(int argc, char** argv) {
  const auto run = [](ros::NodeHandle& node, ros::NodeHandle& private_node, CameraConfig& config) {
    const CameraDriver driver(node, private_node, config);
    warnOfExposure();
    ros::spin();
  };
  return configuredNode<CameraConfig>(argc, argv, "camera", run);
}
