#include "laparoscope_servo/motion/motion_model.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

#include "laparoscope_servo/robust/largest.h"

namespace laparoscope_servo::motion {

namespace {

// px: a unit with which the eight parameters of usual motions are of similar size.
double unitFor(const Eigen::Vector2d& centre) {
  return std::max(1.0, centre.cwiseAbs().maxCoeff());
}

geometry::Sl3Steps stepsAbout(const Eigen::Vector2d& centre, double unit) {
  Eigen::Matrix3d n;
  n << 1.0 / unit, 0.0, -centre.x() / unit,  //
      0.0, 1.0 / unit, -centre.y() / unit,   //
      0.0, 0.0, 1.0;
  return geometry::Sl3Steps(n);
}

}  // namespace

int parametersOf(Model model) {
  constexpr std::array<int, 3> kCounts = {2, 6, 8};
  return kCounts[static_cast<std::size_t>(model)];
}

Eigen::Matrix<double, 2, 8> fieldJacobian(const Eigen::Vector2d& p) {
  const double x = p.x(), y = p.y();
  Eigen::Matrix<double, 2, 8> j;
  j << 1, 0, x, y, 0, 0, x * x, x * y,  // eq. (8)
      0, 1, 0, 0, x, y, x * y, y * y;
  return j;
}

Eigen::Vector2d MotionField::at(const Eigen::Vector2d& pixel) const {
  return fieldJacobian(pixel - centre) * a;
}

double errorAtCorners(const geometry::Quadrilateral& corners, const Eigen::Vector2d& centre,
                      const Eigen::Matrix<double, 8, 8>& covariance) {
  double worst = 0.0;
  for (const Eigen::Vector2d& corner : corners) {
    const Eigen::Matrix<double, 2, 8> j = fieldJacobian(corner - centre);
    worst = robust::largest(worst, std::sqrt((j * covariance * j.transpose()).trace()));
  }
  return worst;
}

// Eq. (8) with p + by in place of p.
Eigen::Matrix<double, 8, 8> fieldAbout(const Eigen::Vector2d& by) {
  const double x = by.x(), y = by.y();
  Eigen::Matrix<double, 8, 8> t = Eigen::Matrix<double, 8, 8>::Identity();
  t.topRows<2>() = fieldJacobian(by);
  t(2, 6) = 2.0 * x;
  t(2, 7) = t(4, 6) = y;
  t(3, 7) = t(5, 6) = x;
  t(5, 7) = 2.0 * y;
  return t;
}

// geometry::sl3Hat(x) moves (u, v) by (x1 + x3 v + (x5 - x6) u - x7 u^2 - x8 u v,
//                                      x2 + x4 u - (x5 + 2 x6) v - x7 u v - x8 v^2).
Eigen::Matrix<double, 8, 8> fieldFromSl3(double unit) {
  Eigen::Matrix<double, 8, 8> t = Eigen::Matrix<double, 8, 8>::Zero();
  t(0, 0) = t(1, 1) = unit;
  t(2, 4) = 1.0;
  t(2, 5) = -1.0;
  t(3, 2) = 1.0;
  t(4, 3) = 1.0;
  t(5, 4) = -1.0;
  t(5, 5) = -2.0;
  t(6, 6) = t(7, 7) = -1.0 / unit;
  return t;
}

Eigen::Matrix3d homographyOf(const MotionField& field) {
  const double unit = unitFor(field.centre);
  const geometry::Vector8d x = fieldFromSl3(unit).inverse() * field.a;
  return stepsAbout(field.centre, unit).plus(Eigen::Matrix3d::Identity(), x);
}

MotionField fieldOf(const Eigen::Matrix3d& g, const Eigen::Vector2d& centre) {
  const double unit = unitFor(centre);
  MotionField field;
  field.centre = centre;
  field.a = fieldFromSl3(unit) * stepsAbout(centre, unit).minus(g, Eigen::Matrix3d::Identity());
  return field;
}

}  // namespace laparoscope_servo::motion
