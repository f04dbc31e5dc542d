// Node `scope_markers`: see laparoscope_servo/ros/scope_markers.h.
#include <ros/ros.h>

#include "laparoscope_servo/ros/frame_names.h"
#include "laparoscope_servo/ros/scope_markers.h"

namespace skin = laparoscope_servo::skin;

int main(int argc, char** argv) {
  ros::init(argc, argv, "scope_markers");
  ros::NodeHandle node;
  ros::NodeHandle private_node("~");
  skin::ParameterReader reader(skin::parametersOf(private_node), private_node.getNamespace());
  skin::ScopeMarkersConfig config = skin::scopeMarkersConfig(reader);
  if (!reader.errors().empty()) {
    ROS_FATAL("%s", reader.report().c_str());
    return 1;
  }
  config.frame_prefix = skin::framePrefix(config.frame_prefix, node.getNamespace());
  const skin::ScopeMarkers markers(node, private_node, config);
  ros::spin();
  return 0;
}
