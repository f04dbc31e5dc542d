#include "ros/controller/tip_input.h"

#include <cmath>
#include <limits>
#include <optional>

#include "laparoscope_servo/servo/place_error.h"

namespace laparoscope_servo {

namespace {

// The points that InstrumentFeatureTracker names so; others are no instruments'.
bool isTip(const TrackedFeature& feature) {
  const std::string ending = " tip";
  const std::string& id = feature.id;
  return feature.kind == TrackedFeature::POINT && id.size() > ending.size() &&
         id.compare(id.size() - ending.size(), ending.size(), ending) == 0;
}

bool isSeen(const TrackedFeature& tip) {
  return tip.state == TrackedFeatures::TRACKING && tip.parameters.size() == 2;
}

std::optional<Eigen::Vector2d> placeOf(const TrackedFeature& tip, const FeatureCamera& camera) {
  return camera.normalised({tip.parameters[0], tip.parameters[1]});
}

}  // namespace

double TipInput::distanceOf(const TrackedFeature& tip, const FeatureCamera& camera) const {
  const std::optional<Eigen::Vector2d> place = isSeen(tip) ? placeOf(tip, camera) : std::nullopt;
  return place ? std::hypot(place->x() - config_.x, place->y() - config_.y) : std::numeric_limits<double>::infinity();
}

const TrackedFeature* TipInput::choose(const TrackedFeatures& message, const FeatureCamera& camera) {
  const TrackedFeature* nearest = nullptr;
  double distance = std::numeric_limits<double>::infinity();
  for (const TrackedFeature& feature : message.features) {
    if (!isTip(feature)) continue;
    if (feature.id == chosen_) return &feature;
    const double there = distanceOf(feature, camera);
    if (!(there < distance)) continue;
    nearest = &feature;
    distance = there;
  }
  if (!chosen_.empty() || nearest == nullptr) return nullptr;
  chosen_ = nearest->id;
  ++number_;
  return nearest;
}

servo::TaskErrorInput TipInput::from(const TrackedFeatures& message, const FeatureCamera& camera) {
  servo::TaskErrorInput input;
  input.problem = camera.problem();
  if (!input.problem.empty()) return input;
  if (!camera.hasSizeOf(message)) {
    input.problem = "the tip is of images of another size than camera_info says";
    return input;
  }
  const TrackedFeature* const tip = choose(message, camera);
  input.region = number_;
  if (tip == nullptr || !isSeen(*tip)) return input;
  const std::optional<Eigen::Vector2d> place = placeOf(*tip, camera);
  if (!place) {
    input.problem = "the tip is outside of what the lens shows, or not finite";
    return input;
  }
  input.error = servo::placeError(*place, {config_.x, config_.y});
  input.valid = true;
  input.visible_fraction = tip->share;
  input.corner_error = tip->expected_error;
  return input;
}

}  // namespace laparoscope_servo
