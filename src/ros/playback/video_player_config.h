// The parameters of the player of recordings.
#pragma once

#include <string>
#include <vector>

#include "laparoscope_servo/parameters/table.h"

namespace laparoscope_servo {

struct VideoPlayerConfig {
  std::string video;              // bag, video file, or folder of images; several bags: see inputsOf
  std::string folder;             // of relative paths; empty: the working directory
  std::string image_topic;        // of a bag; may be empty if it has only one topic with images
  std::string camera_info_topic;  // of a bag; empty: camera_info beside the images
  std::string camera_info;        // file of camera_calibration (YAML or INI); empty: intrinsics unknown
  std::string frame_id = "laparoscope_optical";
  double fps = 25.0;             // Hz, 0.1 to 1000, for a folder and for a video without a rate
  double speed = 1.0;            // 0.01 to 100: 2 plays twice as fast
  double start = 0.0;            // s, >= 0: images before are skipped
  double first_stamp = 1.0;      // s, > 0, of the video's first image; 0 means "no time" in ROS
  bool loop = false;             // starts again at the end
  bool stay = false;             // the node does not end with the video, so that the last image stays visible
  bool restart_time = true;      // false: stamps go on at a loop instead of jumping back
  bool clock = true;             // publishes /clock
  bool lockstep = false;         // the next image waits for the tracker's result, so that a slow tracker misses none
  bool hold = false;             // holds at the first image until a region is selected or the command to play comes
  bool wait_for_screen = false;  // waits for a subscriber of ~state before the first image, see also run()
  int subscribers = 1;           // 0 to 100: waits for this number of subscribers of image_raw before the first image
};

// Adds the rows of the private parameters.
void describe(parameters::Table& table, VideoPlayerConfig& config);
std::vector<std::string> validate(const VideoPlayerConfig& config);

}  // namespace laparoscope_servo
