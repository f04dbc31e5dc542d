#include "laparoscope_servo/sim/scope_body.h"

namespace laparoscope_servo::sim {

geometry::Vector6d ScopeBody::tipTwist(const geometry::Vector6d& end_effector_twist) const {
  const Eigen::Isometry3d tip_T_end_effector(Eigen::Translation3d(0.0, 0.0, -length_));
  return geometry::twistTransform(tip_T_end_effector) * end_effector_twist;
}

void ScopeBody::move(const geometry::Vector6d& end_effector_twist, double dt) {
  if (wrist_ == Wrist::kStiff) {
    world_T_tip_ = world_T_tip_ * geometry::se3Exp(dt * tipTwist(end_effector_twist));
    return;
  }
  world_T_tip_.translation() += dt * (world_T_tip_.linear() * end_effector_twist.head<3>());
  world_T_tip_.linear() = world_T_tip_.linear() * geometry::so3Exp({0.0, 0.0, dt * end_effector_twist[5]});
  aim();
}

void ScopeBody::moveInsertionPoint(const Eigen::Vector3d& insertion_point) {
  insertion_point_ = insertion_point;
  if (wrist_ == Wrist::kPassive) aim();
}

// Turns the scope about O_7 by the smallest angle for which its shaft passes through the insertion point.
void ScopeBody::aim() {
  const Eigen::Vector3d end_effector = world_T_tip_ * Eigen::Vector3d(0.0, 0.0, -length_);
  const Eigen::Vector3d axis = world_T_tip_.linear().col(2);
  const Eigen::Quaterniond turn = Eigen::Quaterniond::FromTwoVectors(axis, insertion_point_ - end_effector);
  world_T_tip_.linear() = (turn * Eigen::Quaterniond(world_T_tip_.linear())).normalized().toRotationMatrix();
  world_T_tip_.translation() = end_effector + length_ * world_T_tip_.linear().col(2);
}

}  // namespace laparoscope_servo::sim
