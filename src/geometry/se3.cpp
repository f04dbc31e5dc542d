#include "laparoscope_servo/geometry/se3.h"

#include <Eigen/SVD>
#include <cmath>

namespace laparoscope_servo::geometry {

Eigen::Matrix3d skew(const Eigen::Vector3d& w) {
  Eigen::Matrix3d m;
  m << 0.0, -w.z(), w.y(),  //
      w.z(), 0.0, -w.x(),   //
      -w.y(), w.x(), 0.0;
  return m;
}

Eigen::Vector3d vee(const Eigen::Matrix3d& m) {
  return 0.5 * Eigen::Vector3d(m(2, 1) - m(1, 2), m(0, 2) - m(2, 0), m(1, 0) - m(0, 1));
}

Eigen::Matrix3d so3Exp(const Eigen::Vector3d& w) {
  const double angle = w.norm();
  if (angle == 0.0) return Eigen::Matrix3d::Identity();
  return Eigen::AngleAxisd(angle, w / angle).toRotationMatrix();
}

Eigen::Vector3d so3Log(const Eigen::Matrix3d& r) {
  const Eigen::AngleAxisd rotation(r);
  return rotation.angle() * rotation.axis();
}

Eigen::Matrix3d nearestRotation(const Eigen::Matrix3d& m) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(m, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::Matrix3d u = svd.matrixU(), v = svd.matrixV();
  return u * Eigen::Vector3d(1.0, 1.0, (u * v.transpose()).determinant()).asDiagonal() * v.transpose();
}

double angleBetween(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

Eigen::Isometry3d se3Exp(const Vector6d& twist) {
  const Eigen::Vector3d v = twist.head<3>();
  const Eigen::Vector3d w = twist.tail<3>();
  const double angle2 = w.squaredNorm();
  const double angle = std::sqrt(angle2);
  // The left Jacobian of SO(3); by its series where the closed form is 0 / 0.
  double b = 0.5 - angle2 / 24.0;
  double c = 1.0 / 6.0 - angle2 / 120.0;
  if (angle > 1e-4) {
    b = (1.0 - std::cos(angle)) / angle2;
    c = (angle - std::sin(angle)) / (angle2 * angle);
  }
  const Eigen::Matrix3d x = skew(w);
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  motion.linear() = so3Exp(w);
  motion.translation() = v + b * x * v + c * x * x * v;
  return motion;
}

Matrix6d twistTransform(const Eigen::Isometry3d& a_T_b) {
  const Eigen::Matrix3d r = a_T_b.linear();
  Matrix6d m;
  m << r, skew(a_T_b.translation()) * r,  //
      Eigen::Matrix3d::Zero(), r;
  return m;
}

}  // namespace laparoscope_servo::geometry
