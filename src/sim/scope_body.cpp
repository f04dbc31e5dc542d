#include "laparoscope_servo/sim/scope_body.h"

namespace laparoscope_servo::sim {

geometry::Vector6d ScopeBody::cameraTwist(const geometry::Vector6d& end_effector_twist) const {
  const Eigen::Isometry3d camera_T_end_effector(Eigen::Translation3d(0.0, 0.0, -length_));
  return geometry::twistTransform(camera_T_end_effector) * end_effector_twist;
}

void ScopeBody::move(const geometry::Vector6d& end_effector_twist, double dt) {
  world_T_camera_ = world_T_camera_ * geometry::se3Exp(dt * cameraTwist(end_effector_twist));
}

}  // namespace laparoscope_servo::sim
