#include "servo/shaping/workspace.h"

#include <algorithm>
#include <cmath>

namespace laparoscope_servo::servo {

namespace {

// 1 far from the bound, 0 at the bound and beyond, and 0 for NaN.
double share(double room, double margin) {
  if (!(room > 0.0)) return 0.0;
  return margin > 0.0 ? std::min(1.0, room / margin) : 1.0;
}

}  // namespace

scope::Velocity within(const Workspace& range, const scope::Velocity& velocity, double d2) {
  scope::Velocity result = velocity;
  const double room = velocity.insertion > 0.0 ? range.max_depth - d2 : d2 - range.min_depth;
  result.insertion *= share(room, range.depth_margin);
  return result;
}

scope::Velocity within(const Workspace& range, const scope::Velocity& velocity, double d2,
                       const Eigen::Matrix3d& insertion_point_R_shaft) {
  scope::Velocity result = within(range, velocity, d2);
  const Eigen::Vector3d axis = Eigen::Vector3d(range.axis[0], range.axis[1], range.axis[2]).normalized();
  const Eigen::Vector3d there =
      insertion_point_R_shaft.transpose() * axis;  // in the shaft's axes, where the shaft is z
  const double angle = std::acos(std::clamp(there.z(), -1.0, 1.0));
  // z moves by (pan, -tilt) in x and y. Outwards is away from the cone's axis; on the axis every direction is outwards.
  const Eigen::Vector2d outwards = -there.head<2>();
  if (!(outwards.norm() > 1e-9)) {
    // the scope points out of the body, or its direction is not finite
    if (!(there.z() > 0.0)) result.pan = result.tilt = 0.0;
    return result;
  }
  const Eigen::Vector2d out = outwards.normalized();
  Eigen::Vector2d motion(result.pan, -result.tilt);
  const double speed = motion.dot(out);
  if (speed > 0.0) motion -= (1.0 - share(range.cone - angle, range.cone_margin)) * speed * out;
  result.pan = motion.x();
  result.tilt = -motion.y();
  return result;
}

}  // namespace laparoscope_servo::servo
