#include "servo/task/parallel/keyed_view.h"

#include <Eigen/LU>
#include <cmath>
#include <stdexcept>

namespace laparoscope_servo::servo {

namespace {

// Normalised: half of what a view of 640 px shows at a focal length of 400 px.
constexpr double kFar = 0.4;
constexpr double kFocalLength = 1000.0;  // px, of a camera in whose pixels the region is given; any would do

// Of the part of the view that the corners bound.
TaskError errorOf(const Eigen::Matrix3d& h, const geometry::Quadrilateral& corners) {
  const Eigen::Vector2d first = kFocalLength * corners[0], last = kFocalLength * corners[2];
  const geometry::Rectangle region{first.x(), first.y(), last.x() - first.x() + 1.0, last.y() - first.y() + 1.0};
  return taskError(h, region, {kFocalLength, kFocalLength, 0.0, 0.0});
}

}  // namespace

std::optional<KeyedError> KeyedView::see(double time, const ViewMotion& motion) {
  if (key_H_anchor_ && time_ == time) return last_;
  time_ = time;
  last_.reset();
  try {
    KeyedError seen;
    if (key_H_anchor_) {
      TaskError error = errorOf(motion.h * key_H_anchor_->inverse(), motion.corners);
      error.log_depth += log_depth_;
      const double away = std::hypot(error.x - error.desired_x, error.y - error.desired_y);
      if (away <= kFar) {
        seen.error = error;
        seen.key = key_;
        last_ = seen;
        return last_;
      }
      seen.key_changed = true;
      seen.last_key = error;
      log_depth_ = error.log_depth;
    } else {
      log_depth_ = 0.0;
    }
    key_H_anchor_ = motion.h;
    key_ += 1.0;
    seen.error = errorOf(Eigen::Matrix3d::Identity(), motion.corners);
    seen.error.log_depth += log_depth_;
    seen.key = key_;
    last_ = seen;
  } catch (const std::invalid_argument&) {
    key_H_anchor_.reset();
  }
  return last_;
}

}  // namespace laparoscope_servo::servo
