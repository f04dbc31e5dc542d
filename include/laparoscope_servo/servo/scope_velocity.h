// The four velocities that an insertion point leaves to a scope: Bourger et al. (2007), eq. (8).
#pragma once

#include <Eigen/Core>

namespace laparoscope_servo::servo {

// In the shaft's axes, z along the shaft into the body; with 0° optics the camera's (optical: x right, y down, z
// forward).
struct ScopeVelocity {
  double pan = 0.0;        // rad/s, Omega_y
  double tilt = 0.0;       // rad/s, Omega_x
  double spin = 0.0;       // rad/s, Omega_z
  double insertion = 0.0;  // m/s, V_z, positive: deeper

  // (pan, tilt, spin, insertion)
  Eigen::Vector4d vector() const { return {pan, tilt, spin, insertion}; }
  static ScopeVelocity fromVector(const Eigen::Vector4d& v) { return {v[0], v[1], v[2], v[3]}; }
};

}  // namespace laparoscope_servo::servo
