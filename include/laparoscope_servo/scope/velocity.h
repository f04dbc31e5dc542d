// The four velocities that an insertion point leaves to a scope: Bourger et al. (2007), eq. (8). At the insertion point
// O_A the scope has the twist (0, 0, V_z, Omega_x, Omega_y, Omega_z): nothing sideways.
#pragma once

#include <Eigen/Core>

namespace laparoscope_servo::scope {

// In the shaft's axes, z along the shaft into the body; with 0° optics the camera's (optical: x right, y down, z
// forward).
struct Velocity {
  double pan = 0.0;        // rad/s, Omega_y of eq. (8)
  double tilt = 0.0;       // rad/s, Omega_x of eq. (8)
  double spin = 0.0;       // rad/s, Omega_z of eq. (8)
  double insertion = 0.0;  // m/s, V_z of eq. (8), positive: deeper

  // (pan, tilt, spin, insertion)
  Eigen::Vector4d vector() const { return {pan, tilt, spin, insertion}; }
  static Velocity fromVector(const Eigen::Vector4d& v) { return {v[0], v[1], v[2], v[3]}; }

  bool isFinite() const { return vector().allFinite(); }
  bool isZero() const { return pan == 0.0 && tilt == 0.0 && spin == 0.0 && insertion == 0.0; }
};

}  // namespace laparoscope_servo::scope
