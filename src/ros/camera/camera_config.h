// The parameters of the camera's driver.
#pragma once

#include <string>
#include <vector>

#include "laparoscope_servo/parameters/table.h"
#include "ros/camera/picture_repair.h"

namespace laparoscope_servo {

struct CameraConfig {
  std::string device = "/dev/video0";  // of Video4Linux; or a video file, or an address that ffmpeg understands
  int width = 0;                       // px, asked of the device; 0: as it is
  int height = 0;                      // px
  double rate = 0.0;                   // Hz, asked of the device; 0: as it is
  std::string pixel_format;            // four letters, e.g. MJPG, asked of the device; empty: as it is
  std::string name = "laparoscope";    // of the camera's calibration, see calibrationFile()
  std::string calibration;             // file; empty: by the name
  std::string frame_id = "laparoscope_optical";
  BayerPattern bayer = BayerPattern::kNone;
  Interlacing interlacing = Interlacing::kNone;
  double delay = 0.0;         // s, that a picture is older than its stamp would say: of grabber and camera
  double max_silence = 1.0;   // s without a picture: an error, said in diagnostics
  double retry_period = 1.0;  // s between two attempts to open the device
};

// The private parameters.
void describe(parameters::Table& table, CameraConfig& config);
std::vector<std::string> validate(const CameraConfig& config);

// As camera_info_manager has it: camera_info/NAME.yaml in ROS_HOME, or in ~/.ros.
std::string calibrationFile(const std::string& name);

}  // namespace laparoscope_servo
