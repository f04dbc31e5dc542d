// The parameters of the camera's driver.
#pragma once

#include <string>
#include <vector>

#include "laparoscope_servo/parameters/table.h"
#include "ros/camera/picture_repair.h"

namespace laparoscope_servo {

struct CameraConfig {
  std::string device = "/dev/video0";  // a Video4Linux device, a video file, or an address for ffmpeg
  int width = 0;                       // px, requested from the device; 0: its own
  int height = 0;                      // px
  double rate = 0.0;                   // Hz, requested from the device; 0: its own
  std::string pixel_format;            // four letters, e.g. MJPG, requested from the device; empty: its own
  std::string name = "laparoscope";    // of the camera's calibration, see calibrationFile()
  std::string calibration;             // file; empty: by the name
  std::string frame_id = "laparoscope_optical";
  BayerPattern bayer = BayerPattern::kNone;
  Interlacing interlacing = Interlacing::kNone;
  double delay = 0.0;         // s, delay of grabber and camera, subtracted from the stamp
  double max_silence = 1.0;   // s without a picture, after which diagnostics report an error
  double retry_period = 1.0;  // s between two attempts to open the device
};

// Adds the rows of the private parameters.
void describe(parameters::Table& table, CameraConfig& config);
std::vector<std::string> validate(const CameraConfig& config);

// The file as in camera_info_manager: camera_info/NAME.yaml in ROS_HOME, or in ~/.ros.
std::string calibrationFile(const std::string& name);

}  // namespace laparoscope_servo
