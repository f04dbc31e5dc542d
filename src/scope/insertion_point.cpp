#include "laparoscope_servo/scope/insertion_point.h"

namespace laparoscope_servo::scope {

using geometry::Vector6d;

Vector6d twistAtInsertionPoint(const Vector6d& camera_twist, double d2) {
  const auto& c = camera_twist;
  Vector6d twist;
  twist << c[0] - d2 * c[4], c[1] + d2 * c[3], c[2], c[3], c[4], c[5];  // eq. (9)
  return twist;
}

Vector6d cameraTwist(const Velocity& velocity, double d2) {
  Vector6d twist;
  twist << d2 * velocity.pan, -d2 * velocity.tilt, velocity.insertion, velocity.tilt, velocity.pan,
      velocity.spin;  // eq. (10)
  return twist;
}

Velocity aboutInsertionPoint(const Vector6d& camera_twist, double d2) {
  Velocity velocity;
  velocity.tilt = -camera_twist[1] / d2;  // eq. (11)
  velocity.pan = camera_twist[0] / d2;    // eq. (11)
  velocity.spin = camera_twist[5];        // eq. (11)
  velocity.insertion = camera_twist[2];   // eq. (11)
  return velocity;
}

Vector6d endEffectorTwist(const Velocity& velocity, double d1) {
  Vector6d twist;
  twist << -d1 * velocity.pan, d1 * velocity.tilt, velocity.insertion, velocity.tilt, velocity.pan,
      velocity.spin;  // eq. (12)
  return twist;
}

}  // namespace laparoscope_servo::scope
