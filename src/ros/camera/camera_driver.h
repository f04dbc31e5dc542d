// The driver of the node and nodelet `camera`. Publishes: image_raw (bgr8 or mono8) and camera_info, each picture once,
// with the time at which it was taken; /diagnostics. A device that delivers no pictures any more is reported and opened
// again until it is back; meanwhile nothing is published.
#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/ros.h>
#include <sensor_msgs/CameraInfo.h>

#include <atomic>
#include <cstdint>
#include <mutex>
#include <string>
#include <thread>

#include "ros/camera/camera_config.h"
#include "ros/camera/camera_source.h"

namespace laparoscope_servo {

class CameraDriver {
 public:
  // Throws std::runtime_error if the given calibration cannot be read.
  CameraDriver(ros::NodeHandle node, ros::NodeHandle private_node, const CameraConfig& config);
  // Waits for the picture that is being read.
  ~CameraDriver();
  CameraDriver(const CameraDriver&) = delete;
  CameraDriver& operator=(const CameraDriver&) = delete;

 private:
  void run();
  // Runs until the device is gone, or the driver ends.
  void play(CameraSource& source);
  void publish(const CameraSource::Picture& picture);
  void wait(double seconds) const;
  void lost(const std::string& why);
  void diagnose(diagnostic_updater::DiagnosticStatusWrapper& status);

  CameraConfig config_;
  std::string calibration_file_;  // empty: not calibrated
  sensor_msgs::CameraInfo camera_info_;
  ros::Publisher image_publisher_;
  ros::Publisher camera_info_publisher_;
  diagnostic_updater::Updater diagnostics_;
  ros::WallTimer diagnostics_timer_;

  std::mutex mutex_;  // guards the members below, up to the thread
  std::string problem_ = "no picture yet";
  std::string notes_;
  std::string size_;
  std::string calibration_problem_;
  double last_picture_;         // s, steady
  std::uint64_t pictures_ = 0;  // since the start
  std::uint64_t repeated_ = 0;
  std::uint64_t openings_ = 0;
  std::uint64_t told_pictures_ = 0;  // number of pictures at the last diagnostics
  double told_at_;                   // s, steady

  std::atomic<bool> ends_{false};
  std::thread thread_;
};

}  // namespace laparoscope_servo
