#include "tracking/align/shift_fit.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <boost/container/static_vector.hpp>
#include <cmath>
#include <limits>

#include "laparoscope_servo/robust/median.h"
#include "laparoscope_servo/robust/scale.h"

namespace laparoscope_servo::tracking {

namespace {

constexpr std::size_t kFew = 5;
constexpr int kRounds = 5;
constexpr double kPlace = 0.15;  // px, least standard deviation of a block's measured place
// Standard deviations of ESM's error at the ROI's border, in units of half its side, before blocks are measured. They
// keep shear and perspective small unless the blocks determine them.
constexpr double kShift = 0.08, kAffine = 0.04, kPerspective = 0.024;

// Pieces of the region that deform independently of each other: a third of it along each side. Corners on the same five
// films with noise of 1 and 3 grey levels and without then differ by 0.2 to 1.1 times what is claimed, in single images
// by up to 4.5; with 36 pieces by 0.25 to 1.2 and 5.1; where nothing of this is claimed by 1.3 and 6.7 on one film.
constexpr double kPieces = 9.0;

Matrix8d knownBefore() {
  geometry::Vector8d spread;
  spread << kShift, kShift, kAffine, kAffine, kAffine, kAffine, kPerspective, kPerspective;
  return spread.cwiseAbs2().cwiseInverse().asDiagonal();
}

template <typename Value>
using OfBlocks = boost::container::static_vector<Value, BlockMatching::kMostBlocks>;  // does not allocate

// A confident block, in normalised template units.
struct Row {
  Eigen::Matrix<double, 2, 8> jacobian;  // derivative of the block's place by x
  Eigen::Vector2d shift;
  double correlation;
};

}  // namespace

int confidentShifts(const std::vector<BlockShift>& shifts) {
  return static_cast<int>(std::count_if(shifts.begin(), shifts.end(), [](const BlockShift& s) { return s.confident; }));
}

double medianShift(const std::vector<BlockShift>& shifts, const Eigen::Matrix3d& g) {
  OfBlocks<double> lengths;
  for (const BlockShift& s : shifts) {
    if (s.confident) lengths.push_back((geometry::apply(g, s.centre + s.shift) - geometry::apply(g, s.centre)).norm());
  }
  return lengths.empty() ? std::numeric_limits<double>::quiet_NaN() : robust::median(lengths);
}

double spreadOfShifts(const std::vector<BlockShift>& shifts, const geometry::Rectangle& roi, double side) {
  // Centres lie from half a block inside of the region's border on.
  const Eigen::Array2d range(std::max(roi.width - side, 1.0), std::max(roi.height - side, 1.0));
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  Eigen::Matrix2d squares = Eigen::Matrix2d::Zero();
  int count = 0;
  for (const BlockShift& s : shifts) {
    if (!s.confident) continue;
    const Eigen::Vector2d p = (s.centre - roi.centre()).array() / range;
    sum += p;
    squares += p * p.transpose();
    ++count;
  }
  if (count == 0) return 0.0;
  const Eigen::Vector2d mean = sum / count;
  const Eigen::Matrix2d covariance = squares / count - mean * mean.transpose();
  const double half_trace = 0.5 * covariance.trace();
  const double least = half_trace - std::hypot(0.5 * (covariance(0, 0) - covariance(1, 1)), covariance(0, 1));
  constexpr double kEven = (BlockMatching::kAlong + 1.0) / (12.0 * (BlockMatching::kAlong - 1));  // variance of a row
  return std::sqrt(std::max(least, 0.0) / kEven);
}

Matrix8d deformationCovariance(const std::vector<BlockShift>& shifts, double median, const geometry::Rectangle& roi) {
  const double deviation = median / robust::kRayleighMedian;  // in each direction
  const int count = confidentShifts(shifts);
  if (!(deviation > kPlace) || count < kDeformationShifts) return Matrix8d::Zero();
  const double left = (deviation * deviation - kPlace * kPlace) / std::pow(halfSize(roi), 2);  // variance
  const double alike = std::max(1.0, static_cast<double>(shifts.size()) / kPieces);            // blocks of one piece
  const Eigen::Matrix3d n = templateFromPixels(roi);
  Matrix8d seen = Matrix8d::Zero();
  for (const BlockShift& s : shifts) {
    if (!s.confident) continue;
    const Eigen::Matrix<double, 2, 8> j = pointJacobian(geometry::apply(n, s.centre));
    seen += j.transpose() * j / alike;
  }
  const Matrix8d known = knownBefore();
  const auto covariance = [&](double variance) -> Matrix8d {
    return (seen / variance + known).ldlt().solve(Matrix8d::Identity());
  };
  // The fit has taken up a part of the deformation, the larger the fewer pieces are seen.
  const double coordinates = 2.0 * count / alike;
  const double parameters = 8.0 - (covariance(left) * known).trace();  // those that the pieces determine
  return covariance(left * coordinates / std::max(coordinates - parameters, 1.0));
}

void DeformationMemory::complete(int confident, Matrix8d& covariance) {
  if (confident >= kDeformationShifts) {
    last_ = covariance;
  } else {
    covariance = last_;
  }
}

std::optional<ShiftFit> fitShifts(const std::vector<BlockShift>& shifts, const geometry::Rectangle& roi, double side) {
  const Eigen::Matrix3d n = templateFromPixels(roi);
  const double unit = halfSize(roi);
  OfBlocks<Row> rows;
  for (const BlockShift& s : shifts) {
    if (s.confident) rows.push_back({pointJacobian(geometry::apply(n, s.centre)), s.shift / unit, s.correlation});
  }
  if (rows.size() < kFew) return std::nullopt;
  const Matrix8d known = knownBefore();
  // Blocks overlap, so their shifts are not independent: each gets the weight of the share of its area that no other
  // block covers.
  const double overlap = std::max(1.0, static_cast<double>(rows.size()) * side * side / (roi.width * roi.height));
  ShiftFit result;
  Matrix8d a = Matrix8d::Zero();
  // standard deviation of a shift in each direction; infinite at first, so that all have the same weight
  double sigma = std::numeric_limits<double>::infinity();
  OfBlocks<double> left;
  for (int round = 0; round < kRounds; ++round) {
    a.setZero();
    geometry::Vector8d b = geometry::Vector8d::Zero();
    const double variance = overlap * std::pow(std::isfinite(sigma) ? sigma : kPlace / unit, 2);
    for (const Row& row : rows) {
      const double length = (row.shift - row.jacobian * result.x).norm();
      const double w = row.correlation * std::min(1.0, robust::kHuber * sigma / std::max(length, 1e-12)) / variance;
      a += w * row.jacobian.transpose() * row.jacobian;
      b += w * row.jacobian.transpose() * row.shift;
    }
    result.x = (a + known).ldlt().solve(b);
    left.clear();
    for (const Row& row : rows) left.push_back((row.shift - row.jacobian * result.x).norm());
    sigma = std::max(kPlace / unit, robust::median(left) / robust::kRayleighMedian);
  }
  if (!result.x.allFinite()) return std::nullopt;
  result.covariance = (a + known).ldlt().solve(Matrix8d::Identity());
  result.significance = result.x.dot(a * result.x) / 8.0;
  return result;
}

}  // namespace laparoscope_servo::tracking
