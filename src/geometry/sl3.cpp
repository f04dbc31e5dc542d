#include "laparoscope_servo/geometry/sl3.h"

#include <Eigen/LU>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <unsupported/Eigen/MatrixFunctions>

namespace laparoscope_servo::geometry {

namespace {

constexpr double kNearIdentity = 0.25;  // distance at which the logarithm's series is summed
constexpr int kTerms = 9;
constexpr int kMaxRoots = 40;
constexpr int kMaxIterations = 60;
constexpr double kQuadratic = 1e-8;  // relative step size from which the error, its square, is negligible

// The principal square root, by Denman and Beavers' iteration with Higham's scaling by the determinant; NaN if there is
// none (an eigenvalue is negative or 0).
Eigen::Matrix3d squareRoot(const Eigen::Matrix3d& a) {
  Eigen::Matrix3d y = a;
  Eigen::Matrix3d z = Eigen::Matrix3d::Identity();
  for (int k = 0; k < kMaxIterations; ++k) {
    const double scale = std::pow(std::abs(y.determinant() * z.determinant()), -1.0 / 6.0);
    const Eigen::Matrix3d next = 0.5 * (scale * y + z.inverse() / scale);
    z = 0.5 * (scale * z + y.inverse() / scale).eval();
    const double change = (next - y).norm();
    y = next;
    if (!(change > kQuadratic * y.norm())) return y;
  }
  return Eigen::Matrix3d::Constant(std::nan(""));
}

}  // namespace

Eigen::Matrix3d sl3Hat(const Vector8d& x) {
  Eigen::Matrix3d a;
  a << x[4], x[2], x[0],         //
      x[3], -x[4] - x[5], x[1],  //
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

// Not Eigen's logarithm, which allocates: this is called for every image.
Vector8d sl3Log(const Eigen::Matrix3d& g) {
  const Eigen::Matrix3d identity = Eigen::Matrix3d::Identity();
  Eigen::Matrix3d root = g;
  double times = 1.0;
  for (int k = 0; (root - identity).norm() > kNearIdentity; ++k, times *= 2.0) {
    if (k == kMaxRoots || !root.allFinite()) return Vector8d::Constant(std::nan(""));
    root = squareRoot(root);
  }
  // log A = 2 artanh Z with Z = (A - I)(A + I)^-1; the series' remainder is below a double's rounding.
  const Eigen::Matrix3d z = (root - identity) * (root + identity).inverse();
  const Eigen::Matrix3d z2 = z * z;
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (int k = kTerms; k >= 0; --k) sum = z2 * sum + identity / (2.0 * k + 1.0);
  return sl3Vee(2.0 * times * z * sum);
}

Eigen::Matrix3d normaliseDeterminant(const Eigen::Matrix3d& g) {
  const Eigen::Matrix3d scaled = g / std::cbrt(g.determinant());
  if (!scaled.allFinite()) {
    std::ostringstream message;
    const Eigen::IOFormat one_line(Eigen::StreamPrecision, Eigen::DontAlignCols, " ", "; ", "", "", "[", "]");
    message << "homography " << g.format(one_line) << " has determinant " << g.determinant()
            << ", expected a finite matrix with a determinant that is not zero";
    throw std::invalid_argument(message.str());
  }
  return scaled;
}

Eigen::Matrix3d Sl3Steps::plus(const Eigen::Matrix3d& g, const Vector8d& x) const {
  return g * n_inv_ * sl3Exp(x) * n_;
}

Vector8d Sl3Steps::minus(const Eigen::Matrix3d& to, const Eigen::Matrix3d& from) const {
  return sl3Log(normaliseDeterminant(n_ * from.inverse() * to * n_inv_));
}

}  // namespace laparoscope_servo::geometry
