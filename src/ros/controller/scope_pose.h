// Where the scope is, as the controller needs it: d2, the optics and the tip's pose by tf, and why they cannot be used.
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
  // Frames and owner by their full names, see resolveNames().
  explicit ScopePose(const ControllerNodeConfig& config);

  // To be called once in every step.
  servo::DepthInput depth(bool engaged, double steady_now);
  // What is wrong with the pose so that somebody has to look, of the last depth(); empty: nothing.
  const std::string& fault() const { return fault_; }
  // Rotation from a frame's axes to the shaft's; nothing: unknown.
  std::optional<Eigen::Quaterniond> shaftFrom(const std::string& frame) const;
  // ROS time jumped back.
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
