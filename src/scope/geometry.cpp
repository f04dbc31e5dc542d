#include "laparoscope_servo/scope/geometry.h"

namespace laparoscope_servo::scope {

Eigen::Matrix<double, 6, 4> insertionPointMotions(const Geometry& scope) {
  const Eigen::Matrix3d& r = scope.camera_R_shaft;
  Eigen::Matrix<double, 6, 4> motions;
  motions << scope.d2 * r.col(0), -scope.d2 * r.col(1), Eigen::Vector3d::Zero(), r.col(2),  // eq. (10), v
      r.col(1), r.col(0), r.col(2), Eigen::Vector3d::Zero();                                // eq. (10), w
  return motions;
}

Eigen::Matrix3d obliqueOptics(double angle, double roll) {
  const Eigen::Matrix3d shaft_R_camera = geometry::so3Exp({0.0, 0.0, roll}) * geometry::so3Exp({-angle, 0.0, 0.0});
  return shaft_R_camera.transpose();
}

}  // namespace laparoscope_servo::scope
