#include "ros/controller/points_input.h"

#include <algorithm>
#include <optional>

namespace laparoscope_servo {

namespace {

// Normalised; empty where the lens shows nothing.
std::optional<Eigen::Vector2d> placeOf(const std::vector<double>& pixel, const FeatureCamera& camera) {
  const std::optional<Eigen::Vector2d> seen = camera.withoutLens({pixel[0], pixel[1]});
  if (!seen || !seen->allFinite()) return std::nullopt;
  return Eigen::Vector2d((camera.camera().inverseMatrix() * seen->homogeneous()).head<2>());
}

}  // namespace

void PointsInput::take(const TrackedFeatures& message, const FeatureCamera& camera) {
  points_.clear();
  middle_.setZero();
  for (const TrackedFeature& feature : message.features) {
    if (feature.kind != TrackedFeature::POINT || feature.desired.size() != 2) continue;
    const std::optional<Eigen::Vector2d> desired = placeOf(feature.desired, camera);
    if (!desired) continue;
    servo::PointTask& point = points_.emplace_back();
    point.desired = *desired;
    point.weight = 0.0;
    middle_ += *desired;
    if (feature.state != TrackedFeatures::TRACKING || feature.parameters.size() != 2) continue;
    const std::optional<Eigen::Vector2d> place = placeOf(feature.parameters, camera);
    if (!place) continue;
    point.point = *place;
    point.weight = 1.0;
  }
  if (!points_.empty()) middle_ /= static_cast<double>(points_.size());
}

servo::TaskErrorInput PointsInput::from(const TrackedFeatures& message, const FeatureCamera& camera,
                                        const servo::DepthInput& depth) {
  servo::TaskErrorInput input;
  input.problem = camera.problem();
  input.region = message.selection_stamp.toSec();
  if (!input.problem.empty()) return input;
  if (static_cast<int>(message.width) != camera.size().width ||
      static_cast<int>(message.height) != camera.size().height) {
    input.problem = "the points are of images of another size than camera_info says";
    return input;
  }
  take(message, camera);
  if (static_cast<int>(points_.size()) < config_.min_points) {
    input.problem = "fewer points than points/min_points have desired places: select them with 'desired' or 'stored'";
    return input;
  }
  if (message.selection_stamp != selected_ || !has_scope_) {
    selected_ = message.selection_stamp;
    scope_ = {depth.camera_R_shaft, depth.d2};
    has_scope_ = depth.problem.empty() && depth.d2 > 0.0;
  }
  if (!has_scope_) {
    input.problem = "depth d2 is unknown";
    return input;
  }
  const servo::PointsSeen seen = error_.from(points_, middle_, scope_);
  input.valid = seen.is_known;
  if (!input.valid) return input;
  input.error = seen.error;
  input.visible_fraction = static_cast<double>(seen.agreeing) / static_cast<double>(points_.size());
  input.corner_error = std::max(camera.camera().fx, camera.camera().fy) * seen.stddev;
  return input;
}

}  // namespace laparoscope_servo
