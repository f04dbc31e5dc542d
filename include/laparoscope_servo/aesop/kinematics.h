// Forward kinematics of the arm, its Jacobian, and the passive wrist that the trocar holds.
//
// Frames: 0 is aesop_base, k (1 to 7) is fixed to link k, 7 is end_effector with O_7 on the shaft and the z axis along
// the shaft into the body. With 0° optics the camera's frame (optical, REP-103) is parallel to frame 7 and lies
// scope_length along z. Functions take any finite joint positions, also outside the limits.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <string>
#include <vector>

#include "laparoscope_servo/aesop/kinematics_config.h"

namespace laparoscope_servo::aesop {

using Jacobian = Eigen::Matrix<double, 6, kJoints>;

// Joint positions at which the shaft's line passes through the insertion point.
struct WristSolution {
  bool ok = false;
  JointVector q = JointVector::Zero();
  double distance = 0.0;  // m, from the insertion point to the shaft's line
  std::string reason;     // why there is no solution, if not ok
};

class Kinematics {
 public:
  // Throws std::invalid_argument that lists the errors of the configuration.
  explicit Kinematics(const KinematicsConfig& config);

  const KinematicsConfig& config() const { return config_; }
  // Indices (0 to 6) of the 4 driven joints, in the order of the arm. Two other joints are passive.
  const std::vector<int>& driven() const { return driven_; }
  const std::vector<int>& passive() const { return passive_; }
  bool isDriven(int joint) const { return config_.joints[static_cast<std::size_t>(joint)].role == JointRole::kDriven; }

  // aesop_base_T_k for k = 0 (identity) to 7.
  std::array<Eigen::Isometry3d, kJoints + 1> linkFrames(const JointVector& q) const;
  // aesop_base_T_end_effector.
  Eigen::Isometry3d endEffector(const JointVector& q) const { return linkFrames(q)[kJoints]; }
  // end_effector_T_laparoscope_optical, of a 0° scope.
  Eigen::Isometry3d opticalInEndEffector() const;
  // aesop_base_T_laparoscope_optical.
  Eigen::Isometry3d optical(const JointVector& q) const { return endEffector(q) * opticalInEndEffector(); }

  // Geometric Jacobian: joint velocities to the velocity of O_7 [m/s] (rows 0 to 2) and the angular velocity of frame 7
  // [rad/s] (rows 3 to 5), both expressed in aesop_base.
  Jacobian jacobian(const JointVector& q) const;

  // d1: distance along the shaft from O_7 to the insertion point [m, in aesop_base]; negative when it lies behind O_7.
  double leverArm(const JointVector& q, const Eigen::Vector3d& insertion_point) const;

  // Moves the passive joints of `q` (Newton's method from their present positions) until the shaft's line passes
  // through the insertion point [m, in aesop_base] to 1e-12 m. Not ok when that point is within 1 cm of O_7 or behind
  // it, when a passive joint would leave its limits, or when no position near is found.
  WristSolution solveWrist(const JointVector& q, const Eigen::Vector3d& insertion_point) const;

  // Why `q` is impossible: not finite, or a joint (named) outside its limits. Empty if it is possible.
  std::string error(const JointVector& q) const;

 private:
  KinematicsConfig config_;
  std::vector<int> driven_;
  std::vector<int> passive_;
};

}  // namespace laparoscope_servo::aesop
