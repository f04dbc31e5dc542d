#include "ros/controller/points_input.h"

#include <algorithm>
#include <optional>

namespace laparoscope_servo {

void PointsInput::take(const TrackedFeatures& message, const FeatureCamera& camera) {
  points_.clear();
  middle_.setZero();
  for (const TrackedFeature& feature : message.features) {
    if (feature.kind != TrackedFeature::POINT || feature.desired.size() != 2) continue;
    const std::optional<Eigen::Vector2d> desired = camera.normalised({feature.desired[0], feature.desired[1]});
    if (!desired) continue;
    servo::PointTask& point = points_.emplace_back();
    point.desired = *desired;
    point.weight = 0.0;
    middle_ += *desired;
    if (feature.state != TrackedFeatures::TRACKING || feature.parameters.size() != 2) continue;
    const std::optional<Eigen::Vector2d> place = camera.normalised({feature.parameters[0], feature.parameters[1]});
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
  if (!camera.hasSizeOf(message)) {
    input.problem = "the points are of images of another size than camera_info says";
    return input;
  }
  take(message, camera);
  if (static_cast<int>(points_.size()) < config_.min_points) {
    input.problem = "fewer points than points/min_points have desired places: select them with 'desired' or 'stored'";
    return input;
  }
  const std::optional<scope::Geometry>& scope = scope_.of(message.selection_stamp, depth);
  if (!scope) {
    input.problem = "depth d2 is unknown";
    return input;
  }
  const servo::PointsSeen seen = error_.from(points_, middle_, *scope);
  input.valid = seen.is_known;
  if (!input.valid) return input;
  input.error = seen.error;
  input.visible_fraction = static_cast<double>(seen.agreeing) / static_cast<double>(points_.size());
  input.corner_error = std::max(camera.camera().fx, camera.camera().fy) * seen.stddev;
  return input;
}

}  // namespace laparoscope_servo
