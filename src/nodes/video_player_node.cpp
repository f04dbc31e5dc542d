// Node `video_player`: see ros/playback/video_player.h.
#include <filesystem>

#include "nodes/configured_node.h"
#include "ros/playback/video_player.h"

using namespace laparoscope_servo;

int main(int argc, char** argv) {
  const auto run = [](ros::NodeHandle& node, ros::NodeHandle&, VideoPlayerConfig& config) {
    if (!config.folder.empty()) std::filesystem::current_path(config.folder);
    VideoPlayer player(node, config);
    player.run();
    // Publishing is asynchronous: the last images must be sent before the connections close.
    ros::WallDuration(0.5).sleep();
  };
  return configuredNode<VideoPlayerConfig>(argc, argv, "video_player", run);
}
