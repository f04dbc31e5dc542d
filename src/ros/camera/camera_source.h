// A camera, a video file or an address, opened by OpenCV: pictures with the time at which they were taken.
#pragma once

#include <ros/time.h>

#include <chrono>
#include <cstdint>
#include <opencv2/core.hpp>
#include <opencv2/videoio.hpp>
#include <optional>
#include <string>

#include "ros/camera/camera_config.h"

namespace laparoscope_servo {

// Time at which a picture was taken. `captured`: s, on the kernel's monotonic clock, by Video4Linux; `monotonic_now`:
// s, on that clock; `now`: ROS time. Returns `now` for an implausible `captured` (in the future, or older than 1 s).
ros::Time captureStamp(double captured, double monotonic_now, const ros::Time& now);

class CameraSource {
 public:
  struct Picture {
    cv::Mat image;
    ros::Time stamp;
  };

  // Throws std::runtime_error with what cannot be opened, and what was expected. If the device does not have the
  // requested size or rate, its own is used, which notes() reports.
  explicit CameraSource(const CameraConfig& config);

  // Waits for the next picture; with a file, until it is due. Empty if its device time is that of the last one, since
  // it is then the same picture again. Throws std::runtime_error if the device delivers no more pictures.
  std::optional<Picture> next();

  const std::string& notes() const { return notes_; }

 private:
  void ask(int property, double value, const char* what);
  void pace();
  ros::Time stamp() const;

  CameraConfig config_;
  cv::VideoCapture capture_;
  std::string notes_;
  bool is_video4linux_ = false;
  bool is_file_ = false;
  double device_time_ = -1.0;                  // ms, of Video4Linux
  std::chrono::steady_clock::time_point due_;  // time of a file's next picture
};

}  // namespace laparoscope_servo
