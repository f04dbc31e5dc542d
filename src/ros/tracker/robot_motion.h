// The camera's motion between two images by tf, for the tracker's prediction.
#pragma once

#include <ros/time.h>
#include <tf2/buffer_core.h>

#include <Eigen/Geometry>
#include <optional>
#include <string>

namespace laparoscope_servo {

struct RobotMotionConfig {
  bool enabled = false;
  std::string fixed_frame = "aesop_base";  // frame in which the tissue is at rest
  double depth = 0.08;                     // m, 0.005 to 1: depth of the tissue, assumed parallel to the image
  std::string frame_prefix = "auto";       // prefix of fixed_frame, unless that has a slash; auto: the namespace
  std::string owner = "aesop";             // the node whose tf is accepted; empty: the first publisher of a frame
};

// The full name of fixed_frame.
std::string fixedFrame(const RobotMotionConfig& config, const std::string& name_space);

// The motion to_T_from of `frame` in `fixed_frame`. Does not wait: if tf has no pose, or a non-finite one, at one of
// the times, it is empty, and `why` has the reason.
std::optional<Eigen::Isometry3d> cameraMotion(const tf2::BufferCore& tf, const std::string& fixed_frame,
                                              const std::string& frame, const ros::Time& from, const ros::Time& to,
                                              std::string& why);

}  // namespace laparoscope_servo
