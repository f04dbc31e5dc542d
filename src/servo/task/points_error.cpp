#include "laparoscope_servo/servo/points_error.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>

#include "servo/task/scope_displacement.h"

namespace laparoscope_servo::servo {

namespace {

constexpr int kUnknowns = 4;
constexpr int kMaxSteps = 30;
// Of two points each: with 40 % astray a third of them are of two that are not.
constexpr std::size_t kPairs = 200;
constexpr double kConverged = 1e-5;  // rad and m, the last step: 0.01 px at a focal length of 1000 px

// lambda = 1: a step leads all the way.
RobustPointGains stepGains(const PointsConfig& config) {
  RobustPointGains gains;
  gains.rate = 1.0;
  gains.min_noise = config.min_noise;
  return gains;
}

}  // namespace

PointsError::PointsError(const PointsConfig& config, double desired_depth)
    : config_(config), desired_depth_(desired_depth), law_(stepGains(config)) {}

Eigen::Vector4d PointsError::start(const Eigen::Vector2d& middle, const scope::Geometry& scope) {
  const std::size_t n = usable_.size();
  if (n < 2) return Eigen::Vector4d::Zero();
  double least = std::numeric_limits<double>::infinity();
  TaskError best;
  const auto placed = [](const Eigen::Vector2d& p) { return std::complex<double>(p.x(), p.y()); };
  // Of each pair the second one is first half of the list away, then further: neighbours tell no turn.
  for (std::size_t k = 0; k < std::min(kPairs, n * (n - 1) / 2); ++k) {
    const PointTask& one = steps_[usable_[k % n]];
    const PointTask& other = steps_[usable_[(k % n + n / 2 + k / n) % n]];
    const std::complex<double> grown =
        (placed(other.desired) - placed(one.desired)) / (placed(other.point) - placed(one.point));
    const std::complex<double> shift = placed(one.desired) - grown * placed(one.point);
    if (!(std::abs(grown) > 0.0) || !std::isfinite(std::abs(grown)) || !std::isfinite(std::abs(shift))) continue;
    distances_.clear();
    for (const std::size_t i : usable_) {
      distances_.push_back(std::abs(grown * placed(steps_[i].point) + shift - placed(steps_[i].desired)));
    }
    const auto median = distances_.begin() + static_cast<std::ptrdiff_t>(n / 2);
    std::nth_element(distances_.begin(), median, distances_.end());
    if (!(*median < least)) continue;
    least = *median;
    const std::complex<double> there = grown * placed(middle) + shift;
    best.x = there.real();
    best.y = there.imag();
    best.log_depth = -std::log(std::abs(grown));
    best.alpha = std::arg(grown);
  }
  best.desired_x = middle.x();
  best.desired_y = middle.y();
  const Eigen::Vector4d back = displacementToTarget(best, scope, desired_depth_);
  return std::isfinite(least) && back.allFinite() ? Eigen::Vector4d(-back) : Eigen::Vector4d::Zero();
}

// The points as they are in the desired view: `point` is where they would be seen, `desired` where they are.
void PointsError::reset(const std::vector<PointTask>& points) {
  steps_.clear();
  usable_.clear();
  for (const PointTask& task : points) {
    const bool is_usable = task.point.allFinite() && task.desired.allFinite() && task.weight > 0.0;
    if (is_usable) usable_.push_back(steps_.size());
    PointTask& from = steps_.emplace_back();
    from.point = task.desired;
    from.desired = task.point;
    from.depth = desired_depth_;
    from.weight = is_usable ? task.weight : 0.0;
  }
}

// Where the points would be seen after the scope has moved from the desired view by `displacement`. False: one that has
// a say would be behind the camera.
bool PointsError::predict(const Eigen::Vector4d& displacement, const scope::Geometry& scope) {
  for (PointTask& step : steps_) {
    if (!(step.weight > 0.0)) continue;
    const Eigen::Vector3d there = movedPoint(step.depth * step.point.homogeneous(), displacement, scope);
    if (!(there.z() > 0.0)) return false;
    step.point = there.head<2>() / there.z();
    step.depth = there.z();
  }
  return true;
}

PointsSeen PointsError::from(const std::vector<PointTask>& points, const Eigen::Vector2d& middle,
                             const scope::Geometry& scope) {
  PointsSeen seen;
  reset(points);
  Eigen::Vector4d displacement = start(middle, scope);  // from the desired view
  for (int step = 0; step < kMaxSteps; ++step) {
    scope::Geometry desired_scope = scope;
    desired_scope.d2 -= displacement[3];
    reset(points);
    if (!predict(displacement, desired_scope)) return seen;
    const RobustPointVelocity further = law_.velocity(steps_, scope);  // survey, II.C
    if (!further.is_determined) return seen;
    const Eigen::Vector4d change = further.velocity.vector();
    displacement = composed(displacement, change);
    if (!displacement.allFinite()) return seen;
    if (!(change.norm() < kConverged)) continue;
    const std::vector<double>& weights = law_.weights();
    seen.agreeing = static_cast<int>(std::count_if(weights.begin(), weights.end(), [](double d) { return d > 0.0; }));
    if (seen.agreeing < config_.min_points) return seen;
    seen.stddev = further.sigma * std::sqrt(static_cast<double>(kUnknowns) / seen.agreeing);
    TaskError desired;
    desired.x = desired.desired_x = middle.x();
    desired.y = desired.desired_y = middle.y();
    desired.m_star = middle.homogeneous();
    desired_scope.d2 = scope.d2 - displacement[3];
    seen.error = moved(desired, displacement, desired_scope, desired_depth_);
    seen.is_known = isFinite(seen.error);
    return seen;
  }
  return seen;
}

}  // namespace laparoscope_servo::servo
