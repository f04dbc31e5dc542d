#include "laparoscope_servo/geometry/plane_motion.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "laparoscope_servo/geometry/se3.h"

namespace laparoscope_servo::geometry {

namespace {

// Of squared singular values: below it a homography shows nothing but a rotation. A translation of 1e-6 of the plane's
// distance.
constexpr double kRotationOnly = 1e-6;

Eigen::Matrix3d columns(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  Eigen::Matrix3d m;
  m << a, b, a.cross(b);
  return m;
}

}  // namespace

// `u` lies in the plane whose vectors h leaves as long as they are, with v2; so h is a rotation there.
std::array<PlaneMotion, 2> planeMotions(const Eigen::Matrix3d& h, const Eigen::Vector3d& m) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(h.transpose() * h);  // eigenvalues grow
  const double most = solver.eigenvalues()[2], least = solver.eigenvalues()[0];
  std::array<PlaneMotion, 2> motions;
  if (!(most - least > kRotationOnly)) {
    motions[0].rotation = motions[1].rotation = nearestRotation(h);
    return motions;
  }
  const Eigen::Vector3d v1 = solver.eigenvectors().col(2), v2 = solver.eigenvectors().col(1),
                        v3 = solver.eigenvectors().col(0);
  const double a = std::sqrt(std::max(0.0, 1.0 - least)), b = std::sqrt(std::max(0.0, most - 1.0));
  for (std::size_t k = 0; k < 2; ++k) {
    const Eigen::Vector3d u = (a * v1 + (k == 0 ? b : -b) * v3).normalized();
    PlaneMotion& motion = motions[k];
    motion.rotation = nearestRotation(columns(h * v2, h * u) * columns(v2, u).transpose());
    motion.normal = v2.cross(u);
    if (motion.normal.dot(m) < 0.0) motion.normal = -motion.normal;
    motion.translation = (h - motion.rotation) * motion.normal;
  }
  return motions;
}

}  // namespace laparoscope_servo::geometry
