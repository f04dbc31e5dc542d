#include "ros/controller/object_place.h"

#include <cmath>
#include <cstddef>
#include <optional>

#include "laparoscope_servo/servo/place_error.h"

namespace laparoscope_servo {

namespace {

// A region that was selected is one motion with four corners that do not hold the whole image.
bool isOfRegion(const TrackedFeatures& message) {
  if (message.features.size() != 1 || message.selection_stamp.isZero()) return false;
  const TrackedFeature& motion = message.features[0];
  return motion.kind == TrackedFeature::MOTION && motion.outline.size() >= 8;
}

Eigen::Vector2d middleOf(const std::vector<double>& outline) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (std::size_t k = 0; k < 4; ++k) sum += Eigen::Vector2d(outline[2 * k], outline[2 * k + 1]);
  return 0.25 * sum;
}

bool isInside(const Eigen::Vector2d& pixel, const cv::Size& size) {
  return pixel.x() >= 0.0 && pixel.y() >= 0.0 && pixel.x() <= size.width - 1.0 && pixel.y() <= size.height - 1.0;
}

}  // namespace

servo::TaskErrorInput ObjectPlace::from(const TrackedFeatures& message, const FeatureCamera& camera) {
  servo::TaskErrorInput input;
  input.problem.clear();
  input.region = message.selection_stamp.toSec();
  if (message.selection_stamp != selected_) {
    selected_ = message.selection_stamp;
    variance_ = 0.0;
    is_lost_ = false;
  }
  if (!isOfRegion(message)) {
    input.problem =
        "no object was selected that is to be followed: select_features of the node of the motion, by a region";
    return input;
  }
  const TrackedFeature& motion = message.features[0];
  const bool is_selection = message.header.stamp == message.selection_stamp;  // nothing has moved since
  const bool is_seen = is_selection || motion.state == TrackedFeatures::TRACKING;
  is_lost_ = is_lost_ || !is_seen;
  if (is_lost_) {
    input.problem = "the object was lost, and its region may lie on something else: select it again";
    return input;
  }
  if (!is_selection) variance_ += motion.expected_error * motion.expected_error;
  if (!camera.problem().empty()) {
    input.problem = camera.problem();
    return input;
  }
  if (!camera.hasSizeOf(message)) {
    input.problem = "the motion of the object is of images of another size than camera_info says";
    return input;
  }
  const Eigen::Vector2d middle = middleOf(motion.outline);
  const std::optional<Eigen::Vector2d> place =
      isInside(middle, camera.size()) ? camera.normalised(middle) : std::nullopt;
  if (!place) {
    input.problem = "the object leaves: its middle is outside of the image, or not finite";
    return input;
  }
  input.error = servo::placeError(*place, {config_.x, config_.y});
  input.valid = true;
  input.visible_fraction = is_selection ? 1.0 : motion.share;
  input.corner_error = std::sqrt(variance_);
  return input;
}

}  // namespace laparoscope_servo
