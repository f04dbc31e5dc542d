#include "laparoscope_servo/geometry/sl3.h"

#include <cmath>
#include <sstream>
#include <stdexcept>
#include <unsupported/Eigen/MatrixFunctions>

namespace laparoscope_servo::geometry {

Eigen::Matrix3d sl3Hat(const Vector8d& x) {
  Eigen::Matrix3d a;
  a << x[4], x[2], x[0],          //
      x[3], -x[4] - x[5], x[1],   //
      x[6], x[7], x[5];
  return a;
}

Vector8d sl3Vee(const Eigen::Matrix3d& a) {
  const Eigen::Matrix3d b = a - a.trace() / 3.0 * Eigen::Matrix3d::Identity();
  Vector8d x;
  x << b(0, 2), b(1, 2), b(0, 1), b(1, 0), b(0, 0), b(2, 2), b(2, 0), b(2, 1);
  return x;
}

Eigen::Matrix3d sl3Exp(const Vector8d& x) {
  if (!x.allFinite()) return Eigen::Matrix3d::Constant(std::nan(""));
  return sl3Hat(x).exp();
}

Vector8d sl3Log(const Eigen::Matrix3d& g) { return sl3Vee(g.log()); }

Eigen::Matrix3d normaliseDeterminant(const Eigen::Matrix3d& g) {
  const Eigen::Matrix3d scaled = g / std::cbrt(g.determinant());
  if (!scaled.allFinite()) {
    std::ostringstream message;
    const Eigen::IOFormat one_line(Eigen::StreamPrecision, Eigen::DontAlignCols, " ", "; ", "", "", "[", "]");
    message << "homography " << g.format(one_line) << " has determinant " << g.determinant() << ", expected a finite matrix with a determinant that is not zero";
    throw std::invalid_argument(message.str());
  }
  return scaled;
}

}  // namespace laparoscope_servo::geometry
