// Node `scope_markers`: see ros/simulation/scope_markers.h.
#include "nodes/configured_node.h"
#include "ros/common/frame_names.h"
#include "ros/simulation/scope_markers.h"

using namespace laparoscope_servo;

int main(int argc, char** argv) {
  const auto run = [](ros::NodeHandle& node, ros::NodeHandle& private_node, ScopeMarkersConfig& config) {
    config.frame_prefix = framePrefix(config.frame_prefix, node.getNamespace());
    const ScopeMarkers markers(node, private_node, config);
    ros::spin();
  };
  return configuredNode<ScopeMarkersConfig>(argc, argv, "scope_markers", run);
}
