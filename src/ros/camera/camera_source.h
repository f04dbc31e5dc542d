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

// When a picture was taken: `captured` s, by the kernel's monotonic clock as Video4Linux says; `monotonic_now` s, by
// the same clock; `now`: by ROS. What cannot be (from the future, older than 1 s) counts for nothing: it is `now` then.
ros::Time captureStamp(double captured, double monotonic_now, const ros::Time& now);

class CameraSource {
 public:
  struct Picture {
    cv::Mat image;
    ros::Time stamp;
  };

  // Throws std::runtime_error: what cannot be opened, and what was expected. Sizes and rates that the device does not
  // have are taken as it gives them; notes() says so.
  explicit CameraSource(const CameraConfig& config);

  // Waits for the next picture, at a file until it is due. Empty for one that is to be left out: its device time is
  // that of the one before, so that it is the same picture again. Throws std::runtime_error when the device gives none
  // any more.
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
  std::chrono::steady_clock::time_point due_;  // of a file's next picture
};

}  // namespace laparoscope_servo
