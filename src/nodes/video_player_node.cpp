// Node `video_player`: see ros/playback/video_player.h.
#include <ros/ros.h>

#include <cstdlib>
#include <exception>

#include "ros/common/parameters.h"
#include "ros/playback/video_player.h"

using namespace laparoscope_servo;

int main(int argc, char** argv) {
  ros::init(argc, argv, "video_player");
  ros::NodeHandle node;
  const ros::NodeHandle private_node("~");
  ParameterReader reader(parametersOf(private_node), private_node.getNamespace());
  VideoPlayerConfig config;
  reader.readAll(config);
  if (!reader.errors().empty()) {
    ROS_FATAL("%s", reader.report().c_str());
    return EXIT_FAILURE;
  }
  try {
    VideoPlayer player(node, config);
    player.run();
    // Publishing is asynchronous: the last images have to leave before the connections close.
    ros::WallDuration(0.5).sleep();
  } catch (const std::exception& error) {
    ROS_FATAL("%s", error.what());
    return EXIT_FAILURE;
  }
  return EXIT_SUCCESS;
}
