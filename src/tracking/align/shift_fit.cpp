#include "tracking/align/shift_fit.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <boost/container/static_vector.hpp>
#include <cmath>
#include <limits>

#include "laparoscope_servo/robust/median.h"

namespace laparoscope_servo::tracking {

namespace {

constexpr int kFew = 5;
constexpr int kRounds = 5;
constexpr double kHuber = 1.345;      // 95 % efficiency for normal noise; confident blocks are hardly ever outliers
constexpr double kRayleigh = 1.1774;  // median length of a normal vector over its deviation in each direction
constexpr double kPlace = 0.15;       // px, how well a block's place is measured at best
// What ESM may be off by before a block is seen, of half the ROI's side, at its border: shear and perspective are
// believed only as far as blocks show more.
constexpr double kShift = 0.08, kAffine = 0.02, kPerspective = 0.012;

using Lengths = boost::container::static_vector<double, BlockMatching::kMostBlocks>;  // does not allocate

Eigen::Matrix<double, 2, 8> jacobian(const Eigen::Vector2d& p) {
  Eigen::Matrix<double, 2, 8> m;
  m.row(0) = esmJacobianRow(1.0, 0.0, p.x(), p.y());
  m.row(1) = esmJacobianRow(0.0, 1.0, p.x(), p.y());
  return m;
}

}  // namespace

int confidentShifts(const std::vector<BlockShift>& shifts) {
  return static_cast<int>(std::count_if(shifts.begin(), shifts.end(), [](const BlockShift& s) { return s.confident; }));
}

double medianShift(const std::vector<BlockShift>& shifts, const Eigen::Matrix3d& g) {
  Lengths lengths;
  for (const BlockShift& s : shifts) {
    if (s.confident) lengths.push_back((geometry::apply(g, s.centre + s.shift) - geometry::apply(g, s.centre)).norm());
  }
  return lengths.empty() ? std::numeric_limits<double>::quiet_NaN() : robust::median(lengths);
}

std::optional<ShiftFit> fitShifts(const std::vector<BlockShift>& shifts, const geometry::Rectangle& roi, double side) {
  const int count = confidentShifts(shifts);
  if (count < kFew) return std::nullopt;
  const Eigen::Matrix3d n = templateFromPixels(roi);
  const double unit = halfSize(roi);
  geometry::Vector8d spread;
  spread << kShift, kShift, kAffine, kAffine, kAffine, kAffine, kPerspective, kPerspective;
  const Matrix8d known = spread.cwiseAbs2().cwiseInverse().asDiagonal();
  // Blocks overlap, and so tell the same more than once.
  const double overlap = std::max(1.0, count * side * side / (roi.width * roi.height));
  ShiftFit result;
  Matrix8d a = Matrix8d::Zero();
  double sigma = std::numeric_limits<double>::infinity();  // of a shift, each direction; at first all count alike
  Lengths left;
  for (int round = 0; round < kRounds; ++round) {
    a.setZero();
    geometry::Vector8d b = geometry::Vector8d::Zero();
    const double variance = overlap * std::pow(std::isfinite(sigma) ? sigma : kPlace / unit, 2);
    for (const BlockShift& s : shifts) {
      if (!s.confident) continue;
      const Eigen::Matrix<double, 2, 8> m = jacobian(geometry::apply(n, s.centre));
      const Eigen::Vector2d d = s.shift / unit;
      const double w =
          s.correlation * std::min(1.0, kHuber * sigma / std::max((d - m * result.x).norm(), 1e-12)) / variance;
      a += w * m.transpose() * m;
      b += w * m.transpose() * d;
    }
    result.x = (a + known).ldlt().solve(b);
    left.clear();
    for (const BlockShift& s : shifts) {
      if (s.confident) left.push_back((s.shift / unit - jacobian(geometry::apply(n, s.centre)) * result.x).norm());
    }
    sigma = std::max(kPlace / unit, robust::median(left) / kRayleigh);
  }
  if (!result.x.allFinite()) return std::nullopt;
  result.covariance = (a + known).ldlt().solve(Matrix8d::Identity());
  result.significance = result.x.dot(a * result.x) / 8.0;
  return result;
}

}  // namespace laparoscope_servo::tracking
