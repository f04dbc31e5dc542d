// What tf says of the camera's motion between two images, for the tracker's prediction.
#pragma once

#include <ros/time.h>
#include <tf2/buffer_core.h>

#include <Eigen/Geometry>
#include <optional>
#include <string>

namespace laparoscope_servo {

struct RobotMotionConfig {
  bool enabled = false;
  std::string fixed_frame = "aesop_base";  // that the tissue does not move in
  double depth = 0.08;  // m, 0.005 to 1: of the tissue in front of the camera, taken to be parallel to the image
  std::string frame_prefix = "auto";  // in front of fixed_frame, unless it has a slash; auto: the namespace
  std::string owner = "aesop";        // the node whose tf is believed; empty: whoever publishes a frame first
};

// fixed_frame by its full name.
std::string fixedFrame(const RobotMotionConfig& config, const std::string& name_space);

// The motion to_T_from of `frame` in `fixed_frame`. Does not wait: when tf does not know a pose at one of the times, or
// knows one that is not finite, it is empty, and `why` says so.
std::optional<Eigen::Isometry3d> cameraMotion(const tf2::BufferCore& tf, const std::string& fixed_frame,
                                              const std::string& frame, const ros::Time& from, const ros::Time& to,
                                              std::string& why);

}  // namespace laparoscope_servo
