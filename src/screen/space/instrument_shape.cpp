#include "screen/space/instrument_shape.h"

#include <laparoscope_servo/TrackedFeature.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <cmath>

#include "laparoscope_servo/geometry/se3.h"
#include "screen/deviations.h"

namespace laparoscope_servo::screen {

namespace {

constexpr std::size_t kParameters = 6;
constexpr int kRings = 6;        // along what is seen of the shaft
constexpr int kRingParts = 24;   // of a ring
constexpr int kEveryPart = 3;    // of them that a line along the shaft comes from
constexpr int kDashes = 5;       // beyond an open end
constexpr double kDash = 0.004;  // m
constexpr double kOpen = 1.0;    // m: nothing in the abdomen is known so badly, so it is not known at all

// The point of the axis nearest to the ray of a pixel, as the distance from `point` along the axis.
std::optional<double> alongAxis(const geometry::PinholeCamera& camera, const Eigen::Vector3d& point,
                                const Eigen::Vector3d& axis, const QPointF& pixel) {
  const Eigen::Vector3d ray = (camera.inverseMatrix() * Eigen::Vector3d(pixel.x(), pixel.y(), 1.0)).normalized();
  const double cosine = ray.dot(axis);
  const double sine2 = 1.0 - cosine * cosine;
  if (!(sine2 > 1e-9)) return std::nullopt;
  return (cosine * ray.dot(point) - axis.dot(point)) / sine2;
}

struct Tube {
  Eigen::Vector3d point, axis;
  Eigen::Matrix<double, 3, 2> across;  // two directions, perpendicular to the axis and to each other
  geometry::Matrix6d covariance;
  double radius;

  // `along`, m, from the point. A small rotation w about the point moves the axis there by along (w x axis).
  std::vector<Eigen::Vector3d> ring(double along) const {
    Eigen::Matrix<double, 3, 6> jacobian;
    jacobian << Eigen::Matrix3d::Identity(), -along * geometry::skew(axis);
    const Eigen::Matrix<double, 2, 6> lateral = across.transpose() * jacobian;
    const Eigen::Matrix2d spread = lateral * covariance * lateral.transpose();
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(spread);
    const Eigen::Vector2d radii = (kDeviations * solver.eigenvalues().cwiseMax(0.0).cwiseSqrt()).array() + radius;
    if (!(radii.maxCoeff() < kOpen)) return {};
    std::vector<Eigen::Vector3d> points;
    for (int k = 0; k < kRingParts; ++k) {
      const double turn = 2.0 * M_PI * k / kRingParts;
      const Eigen::Vector2d offset(radii.x() * std::cos(turn), radii.y() * std::sin(turn));
      points.push_back(point + along * axis + across * (solver.eigenvectors() * offset));
    }
    return points;
  }
};

Lines spreadOf(const Tube& tube, double from, double to) {
  Lines lines;
  std::vector<Eigen::Vector3d> before;
  for (int k = 0; k < kRings; ++k) {
    std::vector<Eigen::Vector3d> ring = tube.ring(from + k * (to - from) / (kRings - 1));
    if (ring.empty()) return {};
    // The eigenvectors of the next ring may be turned; its point nearest in direction is joined.
    for (std::size_t i = 0; i < ring.size(); ++i) {
      lines.emplace_back(ring[i], ring[(i + 1) % ring.size()]);
      if (before.empty() || i % kEveryPart != 0) continue;
      const Eigen::Vector3d* nearest = &before.front();
      for (const Eigen::Vector3d& candidate : before) {
        const auto off = [&](const Eigen::Vector3d& p) { return (ring[i] - p).cross(tube.axis).squaredNorm(); };
        if (off(candidate) < off(*nearest)) nearest = &candidate;
      }
      lines.emplace_back(*nearest, ring[i]);
    }
    before = std::move(ring);
  }
  return lines;
}

}  // namespace

std::optional<InstrumentShape> instrumentShape(const geometry::PinholeCamera& camera, const FeatureFact& pose) {
  const std::vector<double>& p = pose.parameters;
  if (pose.kind != TrackedFeature::POSE || !(pose.radius > 0.0) || p.size() != kParameters ||
      pose.outline.size() != 2 || !camera.error().empty())
    return std::nullopt;
  const Eigen::Vector3d point(p[0], p[1], p[2]), turn(p[3], p[4], p[5]);
  if (!point.allFinite() || !turn.allFinite() || !(point.z() > 0.0)) return std::nullopt;
  const Eigen::Vector3d axis = geometry::so3Exp(turn) * Eigen::Vector3d::UnitZ();
  const std::optional<double> entry = alongAxis(camera, point, axis, pose.outline[0]);
  const std::optional<double> end = alongAxis(camera, point, axis, pose.outline[1]);
  if (!entry || !end || !(*entry < *end)) return std::nullopt;
  InstrumentShape shape;
  shape.entry = point + *entry * axis;
  shape.end = point + *end * axis;
  shape.radius = pose.radius;
  if (!(shape.entry.z() > 0.0 && shape.end.z() > 0.0)) return std::nullopt;
  if (pose.covariance.size() != kParameters * kParameters) return shape;

  const Eigen::Vector3d any = axis.unitOrthogonal();
  Tube tube{point, axis, {}, Eigen::Map<const geometry::Matrix6d>(pose.covariance.data()), pose.radius};
  tube.across << any, axis.cross(any);
  const double slide = std::sqrt(std::max(0.0, axis.dot(tube.covariance.topLeftCorner<3, 3>() * axis)));
  const bool open = !(slide < kOpen);
  shape.spread = spreadOf(tube, *entry, open ? *end : *end + kDeviations * slide);
  for (int k = 0; open && k < kDashes; ++k)
    shape.open_end.emplace_back(shape.end + (2 * k + 1) * kDash * axis, shape.end + (2 * k + 2) * kDash * axis);
  return shape;
}

}  // namespace laparoscope_servo::screen
