// Converts velocities of the scope about the insertion point to joint velocities, and back: Bourger et al. (2007), eq.
// (8) to (12).
//
// The arm has no remote centre: the driven joints move O_7, and the trocar turns the scope by the passive wrist. So the
// whole motion of O_7 is commanded, and the wrist follows freely.
#pragma once

#include "laparoscope_servo/aesop/kinematics.h"
#include "laparoscope_servo/scope/velocity.h"

namespace laparoscope_servo::aesop {

// Joint velocities; zero for hand joints; for passive joints those that the trocar causes.
struct JointMotion {
  JointVector velocity = JointVector::Zero();
  double scale = 1.0;  // 1: as commanded; 0: refused; between: slowed, all joints alike, so that the direction is kept
  std::string reason;  // why it is slowed or refused; else empty
};

// The smallest singular value of the Jacobian of driven and passive joints, lengths divided by 0.3 m: how far from
// singular.
double conditioning(const Kinematics& kinematics, const JointVector& q);

// The joint velocities for `velocity` at `q`, slowed or refused according to `config`. Non-finite velocities and
// positions are refused, and so is any motion if the shaft is more than 2 cm from the insertion point.
JointMotion jointMotion(const Kinematics& kinematics, const MotionConfig& config, const JointVector& q,
                        const Eigen::Vector3d& insertion_point, const scope::Velocity& velocity);

// The scope's velocity about the insertion point, from joint positions and velocities. Sideways motion of the shaft at
// the insertion point is ignored.
scope::Velocity scopeVelocity(const Kinematics& kinematics, const JointVector& q, const JointVector& qdot);

}  // namespace laparoscope_servo::aesop
