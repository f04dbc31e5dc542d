// Node `recorder`: see ros/recording/recorder.h.
#include "nodes/configured_node.h"
#include "ros/common/network_exposure.h"
#include "ros/recording/recorder.h"

using namespace laparoscope_servo;

int main(int argc, char** argv) {
  const auto run = [](ros::NodeHandle& node, ros::NodeHandle& private_node, RecorderConfig& config) {
    const Recorder recorder(node, private_node, config);
    warnOfExposure();
    ros::spin();
  };
  return configuredNode<RecorderConfig>(argc, argv, "recorder", run);
}
