#include "laparoscope_servo/servo/robust_point_law.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace laparoscope_servo::servo {

namespace {

constexpr int kUnknowns = 4;

bool isUsable(const PointTask& task) {
  return task.point.allFinite() && task.desired.allFinite() && task.depth > 0.0 && std::isfinite(task.depth) &&
         task.weight > 0.0;
}

}  // namespace

Eigen::Matrix<double, 2, 4> pointJacobian(const Eigen::Vector2d& point, double depth, const scope::Geometry& scope) {
  const double x = point.x(), y = point.y();
  Eigen::Matrix<double, 2, 6> interaction;
  interaction << -1.0 / depth, 0.0, x / depth, x * y, -(1.0 + x * x), y,  // x
      0.0, -1.0 / depth, y / depth, 1.0 + y * y, -x * y, -x;              // y
  return interaction * scope::insertionPointMotions(scope);
}

// D (L u + e) is made small by iteratively reweighted least squares, D by what u leaves of e; v = lambda u is then
// -lambda (D L)^+ D e. By e itself, far from the goal, D would refuse the points that have the longest way to go.
RobustPointVelocity RobustPointLaw::velocity(const std::vector<PointTask>& points, const scope::Geometry& scope) {
  rows_.clear();
  for (const PointTask& task : points) {
    const bool is_usable = isUsable(task);
    Eigen::Matrix<double, 2, 4> jacobian = Eigen::Matrix<double, 2, 4>::Zero();
    if (is_usable) jacobian = pointJacobian(task.point, task.depth, scope);
    for (int k = 0; k < 2; ++k) {
      robust::Row row;
      row.count = kUnknowns;
      for (int c = 0; c < kUnknowns; ++c) row.a[static_cast<std::size_t>(c)] = jacobian(k, c);
      row.b = is_usable ? task.desired[k] - task.point[k] : 0.0;
      row.weight = is_usable ? task.weight : 0.0;
      rows_.push_back(row);
    }
  }
  robust::IrlsConfig config;
  config.min_sigma = gains_.min_noise;
  const robust::IrlsResult solved = irls_.solve(kUnknowns, rows_, config);
  weights_.assign(points.size(), 0.0);
  RobustPointVelocity result;
  if (!solved.solved) return result;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (rows_[2 * i].weight > 0.0) weights_[i] = std::min(irls_.weights()[2 * i], irls_.weights()[2 * i + 1]);
  }
  result.is_determined = true;
  result.velocity = scope::Velocity::fromVector(gains_.rate * irls_.x());
  result.sigma = solved.sigma;
  return result;
}

}  // namespace laparoscope_servo::servo
