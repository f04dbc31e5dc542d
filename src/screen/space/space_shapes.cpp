#include "screen/space/space_shapes.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

#include "screen/deviations.h"

namespace laparoscope_servo::screen {

namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr int kRingParts = 48;  // of a circle
constexpr int kArcParts = 12;   // of an arc from the axis to the cone
constexpr int kRulings = 8;     // of the cone

// A direction `angle` off the axis, turned about it by `turn`.
Eigen::Vector3d direction(const Eigen::Quaterniond& axis, double angle, double turn) {
  return axis * Eigen::Vector3d(std::sin(angle) * std::cos(turn), std::sin(angle) * std::sin(turn), std::cos(angle));
}

void addShell(Lines& lines, const Eigen::Quaterniond& axis, double radius, double cone) {
  for (int k = 0; k < kRingParts; ++k) {
    const double from = 2.0 * kPi * k / kRingParts, to = 2.0 * kPi * (k + 1) / kRingParts;
    lines.emplace_back(radius * direction(axis, cone, from), radius * direction(axis, cone, to));
  }
  for (int quarter = 0; quarter < 4; ++quarter) {
    const double turn = 0.5 * kPi * quarter;
    for (int k = 0; k < kArcParts; ++k) {
      const double from = cone * k / kArcParts, to = cone * (k + 1) / kArcParts;
      lines.emplace_back(radius * direction(axis, from, turn), radius * direction(axis, to, turn));
    }
  }
}

}  // namespace

std::optional<Corners3> regionInSpace(const geometry::PinholeCamera& camera, const std::array<double, 9>& g,
                                      const std::array<double, 8>& region, double depth) {
  if (!camera.error().empty() || !(depth > 0.0)) return std::nullopt;
  using RowMajor = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
  const Eigen::Matrix3d k_inverse = camera.inverseMatrix();
  Eigen::Matrix3d h = k_inverse * Eigen::Map<const RowMajor>(g.data()) * camera.matrix();
  if (!h.allFinite()) return std::nullopt;
  // The middle singular value of R + t n'/d is 1.
  const double scale = h.jacobiSvd().singularValues()[1];
  if (!(scale > 0.0)) return std::nullopt;
  h /= scale;
  Corners3 corners;
  for (std::size_t k = 0; k < 4; ++k) {
    corners[k] = depth * (h * (k_inverse * Eigen::Vector3d(region[2 * k], region[2 * k + 1], 1.0)));
    if (!corners[k].allFinite() || !(corners[k].z() > 0.0)) return std::nullopt;
  }
  return corners;
}

Lines boundLines(const ScopeBounds& bounds) {
  if (!(bounds.min_depth > 0.0 && bounds.min_depth <= bounds.max_depth && bounds.cone >= 0.0) ||
      !(bounds.axis.norm() > 0.0) || !bounds.axis.allFinite() || !std::isfinite(bounds.max_depth))
    return {};
  const double cone = std::min(bounds.cone, kPi);
  const auto axis = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), bounds.axis);
  Lines lines;
  addShell(lines, axis, bounds.min_depth, cone);
  addShell(lines, axis, bounds.max_depth, cone);
  for (int k = 0; k < kRulings; ++k) {
    const Eigen::Vector3d along = direction(axis, cone, 2.0 * kPi * k / kRulings);
    lines.emplace_back(bounds.min_depth * along, bounds.max_depth * along);
  }
  return lines;
}

std::optional<Ellipsoid> ellipsoidOf(const Eigen::Matrix3d& covariance) {
  if (!covariance.allFinite()) return std::nullopt;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance);
  if (solver.info() != Eigen::Success || !(solver.eigenvalues()[2] > 0.0)) return std::nullopt;
  // A little below zero is rounding; more is no covariance.
  if (solver.eigenvalues()[0] < -1e-6 * solver.eigenvalues()[2]) return std::nullopt;
  Ellipsoid ellipsoid;
  ellipsoid.axes = solver.eigenvectors();
  if (ellipsoid.axes.determinant() < 0.0) ellipsoid.axes.col(0) *= -1.0;
  ellipsoid.radii = kDeviations * solver.eigenvalues().cwiseMax(0.0).cwiseSqrt();
  return ellipsoid;
}

}  // namespace laparoscope_servo::screen
