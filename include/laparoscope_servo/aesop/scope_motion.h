// Joint velocities for a velocity of the scope about the insertion point, and back: Bourger et al. (2007), eq. (8) to
// (12).
//
// The arm has no remote centre: the driven joints move O_7, and the trocar turns the scope by the passive wrist. What
// has to be commanded is therefore the whole motion of O_7, with the wrist free to follow.
#pragma once

#include "laparoscope_servo/aesop/kinematics.h"
#include "laparoscope_servo/scope/velocity.h"

namespace laparoscope_servo::aesop {

// Joint velocities; those of hand joints are zero, those of passive joints are what the trocar will do to them.
struct JointMotion {
  JointVector velocity = JointVector::Zero();
  double scale = 1.0;  // 1: as asked; 0: refused; between: slowed, all joints alike, so that the direction is kept
  std::string reason;  // why slowed or refused
};

// The smallest singular value of the Jacobian of driven and passive joints, lengths divided by 0.3 m: how far from
// singular.
double conditioning(const Kinematics& kinematics, const JointVector& q);

// What joint velocities give `velocity` at `q`, slowed or refused as `config` says. A velocity or positions that are
// not finite, and an insertion point that the shaft has left by more than 2 cm, are refused.
JointMotion jointMotion(const Kinematics& kinematics, const MotionConfig& config, const JointVector& q,
                        const Eigen::Vector3d& insertion_point, const scope::Velocity& velocity);

// The velocity about the insertion point that the camera's motion amounts to, from joint positions and velocities.
// Sideways motion of the shaft at the insertion point is left out.
scope::Velocity scopeVelocity(const Kinematics& kinematics, const JointVector& q, const JointVector& qdot);

}  // namespace laparoscope_servo::aesop
