// Node `scope_markers`: see ros/simulation/scope_markers.h.
#include <ros/ros.h>

#include "ros/common/frame_names.h"
#include "ros/common/parameters.h"
#include "ros/simulation/scope_markers.h"

using namespace laparoscope_servo;

int main(int argc, char** argv) {
  ros::init(argc, argv, "scope_markers");
  ros::NodeHandle node;
  ros::NodeHandle private_node("~");
  ParameterReader reader(parametersOf(private_node), private_node.getNamespace());
  ScopeMarkersConfig config;
  reader.readAll(config);
  if (!reader.errors().empty()) {
    ROS_FATAL("%s", reader.report().c_str());
    return 1;
  }
  config.frame_prefix = framePrefix(config.frame_prefix, node.getNamespace());
  const ScopeMarkers markers(node, private_node, config);
  ros::spin();
  return 0;
}
