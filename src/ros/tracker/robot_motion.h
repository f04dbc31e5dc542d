// The camera's motion between two images by tf, for a tracker's prediction.
#pragma once

#include <ros/time.h>
#include <tf2/buffer_core.h>

#include <Eigen/Geometry>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "laparoscope_servo/parameters/table.h"
#include "ros/common/owned_transforms.h"

namespace laparoscope_servo {

// That of `frame` from the image at `from` to that at `to`, or why it is not known.
using CameraMotion = std::function<std::optional<Eigen::Isometry3d>(const std::string& frame, const ros::Time& from,
                                                                    const ros::Time& to, std::string& why)>;

struct RobotMotionConfig {
  bool enabled = false;
  std::string fixed_frame = "aesop_base";  // frame in which the tissue is at rest
  double depth = 0.08;                     // m, 0.005 to 1: depth of the tissue, assumed parallel to the image
  std::string frame_prefix = "auto";       // prefix of fixed_frame, unless that has a slash; auto: the namespace
  std::string owner = "aesop";             // the node whose tf is accepted; empty: the first publisher of a frame
};

void describe(parameters::Table& table, RobotMotionConfig& config);

// The full name of fixed_frame.
std::string fixedFrame(const RobotMotionConfig& config, const std::string& name_space);

// The motion to_T_from of `frame` in `fixed_frame`. Does not wait: if tf has no pose, or a non-finite one, at one of
// the times, it is empty, and `why` has the reason.
std::optional<Eigen::Isometry3d> cameraMotion(const tf2::BufferCore& tf, const std::string& fixed_frame,
                                              const std::string& frame, const ros::Time& from, const ros::Time& to,
                                              std::string& why);

// cameraMotion() by what the owner of the robot's tf says.
class RobotFollower {
 public:
  // `node`: in the namespace of the tracker, for the names of frames and owner.
  RobotFollower(const RobotMotionConfig& config, const ros::NodeHandle& node);

  std::optional<Eigen::Isometry3d> motion(const std::string& frame, const ros::Time& from, const ros::Time& to,
                                          std::string& why);
  // Of the last call, for the log: what others say on tf; empty: nothing.
  const std::string& complaint() const { return complaint_; }

 private:
  std::string fixed_frame_;
  std::unique_ptr<OwnedTransforms> transforms_;
  std::string complaint_;
};

}  // namespace laparoscope_servo
