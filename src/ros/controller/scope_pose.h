// The scope's pose from tf for the controller: d2, the optics and the tip's pose, or why they cannot be used.
#pragma once

#include <diagnostic_updater/DiagnosticStatusWrapper.h>
#include <ros/time.h>

#include <Eigen/Geometry>
#include <optional>
#include <string>

#include "laparoscope_servo/servo/controller.h"
#include "laparoscope_servo/servo/pose_watch.h"
#include "ros/common/owned_transforms.h"
#include "ros/common/stamp_watch.h"
#include "ros/controller/controller_parameters.h"

namespace laparoscope_servo {

class ScopePose {
 public:
  // Names of frames and owner must be resolved, see resolveNames().
  explicit ScopePose(const ControllerNodeConfig& config);

  // Call once in every step.
  servo::DepthInput depth(bool engaged, double steady_now);
  // Fault of the pose at the last depth(), for which an operator must look at the arm; empty: none.
  const std::string& fault() const { return fault_; }
  // Rotation from a frame's axes to the shaft's; empty: unknown.
  std::optional<Eigen::Quaterniond> shaftFrom(const std::string& frame) const;
  // Call when ROS time jumped back.
  void clear();
  void describe(diagnostic_updater::DiagnosticStatusWrapper& status) const;

 private:
  servo::DepthInput lookUp(const tf2::BufferCore& tf, bool engaged, double steady_now);
  servo::DepthInput judged(const servo::DepthInput& depth, const geometry_msgs::Transform& camera_T_shaft,
                           const ros::Time& stamp, bool engaged, double steady_now);

  std::string insertion_point_, camera_, shaft_;
  OwnedTransforms transforms_;
  OwnedTransforms::Word word_;
  servo::PoseWatch watch_;
  StampWatch stamps_;
  std::string fault_;
};

}  // namespace laparoscope_servo
