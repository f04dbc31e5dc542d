#include "ros/controller/view_input.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>

#include "laparoscope_servo/motion/motion_model.h"
#include "laparoscope_servo/servo/view_region.h"

namespace laparoscope_servo {

namespace {

constexpr double kSameCorner = 1.0;  // px: corners of images of two sizes are further apart

// The features of an anchored motion are the motion since the anchor, and its last step, see motion_feature_tracker.h.
bool isAnchored(const TrackedFeatures& message) {
  return message.features.size() == 2 && message.features[0].kind == TrackedFeature::MOTION &&
         message.features[1].id == message.features[0].id + " step";
}

// The pixel in the image of one without the lens, moved by `g`, and again without the lens.
Eigen::Vector2d movedThrough(const FeatureCamera& camera, const Eigen::Matrix3d& g, const Eigen::Vector2d& pixel) {
  const std::optional<Eigen::Vector2d> raw = camera.withLens(pixel);
  const std::optional<Eigen::Vector2d> seen = raw ? camera.withoutLens(geometry::apply(g, *raw)) : std::nullopt;
  if (!seen) throw std::invalid_argument("the view is outside of what the lens shows");
  return *seen;
}

// The task error, and the motion that it is of. The texts have no numbers, which would change from image to image.
void read(const TrackedFeature& motion, const FeatureCamera& camera, servo::TaskErrorInput& input) {
  if (!motion.desired.empty()) throw std::invalid_argument("the motion has desired values, expected none");
  const std::size_t count = motion.parameters.size();
  if (count != 2 && count != 6 && count != 8)
    throw std::invalid_argument("the motion has neither 2, 6 nor 8 parameters");
  if (motion.outline.size() < 8) throw std::invalid_argument("the motion has no outline of four corners");
  const geometry::Rectangle frame{0.0, 0.0, static_cast<double>(camera.size().width),
                                  static_cast<double>(camera.size().height)};
  motion::MotionField field;
  field.centre = frame.centre();
  std::copy(motion.parameters.begin(), motion.parameters.end(), field.a.data());
  if (!field.a.allFinite()) throw std::invalid_argument("the motion is not finite");
  const Eigen::Matrix3d g = motion::homographyOf(field);
  geometry::Quadrilateral outline;
  for (std::size_t k = 0; k < 4; ++k) outline[k] = {motion.outline[2 * k], motion.outline[2 * k + 1]};
  if (!(geometry::largestDistance(geometry::apply(g, frame.corners()), outline) <= kSameCorner))
    throw std::invalid_argument("the motion is of images of another size than camera_info says");
  const geometry::Rectangle region = servo::viewRegion(frame.width, frame.height);
  geometry::Quadrilateral seen = region.corners();
  for (Eigen::Vector2d& corner : seen) {
    corner = movedThrough(camera, g, corner);
  }
  try {
    const Eigen::Matrix3d moved = geometry::fromCorners(region.corners(), seen);
    servo::ViewMotion view;
    view.h = geometry::normalisedFromPixels(moved, camera.camera());
    view.corners = geometry::apply(camera.camera().inverseMatrix(), region.corners());
    view.error = motion.expected_error / camera.camera().fx;
    input.error = servo::taskError(view.h, region, camera.camera());
    input.motion = view;
  } catch (const std::invalid_argument&) {
    throw std::invalid_argument("the motion takes the view to where no camera sees it");
  }
}

}  // namespace

servo::TaskErrorInput viewInput(const TrackedFeatures& message, const FeatureCamera& camera) {
  servo::TaskErrorInput input;
  input.problem.clear();
  input.region = message.selection_stamp.toSec();
  if (message.features.empty() || message.features[0].state != TrackedFeatures::TRACKING) return input;
  if (!isAnchored(message)) {
    input.problem = "no image was selected whose view is to be kept: select_features of the node of the motion";
    return input;
  }
  if (!camera.problem().empty()) {
    input.problem = camera.problem();
    return input;
  }
  const TrackedFeature& motion = message.features[0];
  try {
    read(motion, camera, input);
    input.valid = true;
  } catch (const std::invalid_argument& error) {
    input.problem = error.what();
  }
  // By integration alone nothing of the anchor is seen: then what follows the last step counts.
  input.visible_fraction = motion.share > 0.0 ? motion.share : message.features[1].share;
  input.corner_error = motion.expected_error;
  return input;
}

}  // namespace laparoscope_servo
