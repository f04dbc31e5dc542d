#include "ros/playback/video_player_config.h"

namespace laparoscope_servo {

void describe(parameters::Table& table, VideoPlayerConfig& c) {
  table.text("video", c.video, "bag (or several with spaces between), video file or folder of images")
      .required("/path/to/video.mp4");
  table.text("folder", c.folder, "of relative paths; empty: where the node was started");
  table.text("image_topic", c.image_topic, "of a bag; empty: the only one with images");
  table.text("camera_info_topic", c.camera_info_topic, "of a bag; empty: beside the images");
  table.text("camera_info", c.camera_info, "calibration file, YAML or INI; empty: none");
  table.text("frame_id", c.frame_id, "of a video's images; a bag's keep theirs");
  table.number("fps", c.fps, {0.1, 1000}, "Hz", "of a folder, and of a video that does not tell its own");
  table.number("speed", c.speed, {0.01, 100}, "times", "as fast as it was recorded");
  table.number("start", c.start, {0, 1e6}, "s", "what comes before is skipped");
  table.number("first_stamp", c.first_stamp, {1e-3, 1e9}, "s", "of a video's first image");
  table.flag("loop", c.loop, "begins again at the end");
  table.flag("stay", c.stay, "the node goes on at the end, so that the last image can be looked at");
  table.flag("restart_time", c.restart_time, "at a loop stamps jump back; false: they go on");
  table.flag("clock", c.clock, "publishes /clock");
  table.flag("hold", c.hold, "stays at the first image until a region is selected");
  table.flag("wait_for_screen", c.wait_for_screen, "the first image waits for a subscriber of ~state");
  table.flag("lockstep", c.lockstep, "the next image waits for homography, 2 s at most");
  table.number("subscribers", c.subscribers, {0, 100}, "nodes", "to wait for before the first image");
}

std::vector<std::string> validate(const VideoPlayerConfig& config) {
  return parameters::errorsOf(config);
}

}  // namespace laparoscope_servo
