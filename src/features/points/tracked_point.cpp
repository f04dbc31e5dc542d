#include "features/points/tracked_point.h"

#include <Eigen/LU>
#include <algorithm>
#include <utility>

#include "laparoscope_servo/geometry/homography.h"

namespace laparoscope_servo::features {

namespace {

// Of half a window: by how much the comparison with the first view may correct what was followed or found.
constexpr double kMaxCorrection = 0.5;

}  // namespace

void placeBy(const Eigen::Matrix3d& motion, const Eigen::Vector2d& from, PointPose& pose) {
  const Eigen::Vector2d to = geometry::apply(motion, from);
  const Eigen::Matrix2d shape = geometry::derivative(motion, from);
  if (!to.allFinite() || !shape.allFinite() || !(shape.determinant() > 0.0)) return;
  pose.place = to;
  pose.shape = shape;
}

PointComparer::PointComparer(const PointsConfig& config)
    : max_correction_(kMaxCorrection * 0.5 * config.window),
      found_correlation_(0.5 * (1.0 + config.min_correlation)),
      found_share_(0.5 * (1.0 + config.min_share)),
      fitter_(config),
      search_(config.search_range, config.window / 2) {}

void PointComparer::compare(const PointImage& now, TrackedPoint& point) {
  point.fit = fitter_.fit(point.view, now, point.pose);
  point.reason = point.fit.reason;
  const double allowed = max_correction_ * std::max(1.0, point.pose.scale());
  if (point.isSeen() && !((point.fit.pose.place - point.pose.place).norm() <= allowed)) point.reason = Reason::kJump;
}

void PointComparer::look(const PointImage& now, TrackedPoint& point) {
  PointPose found = point.pose;
  if (!now.holds(point.pose.place)) {
    point.reason = Reason::kOutside;
  } else if (!search_.find(point.view, now, found)) {
    point.reason = Reason::kNotSeen;
  } else {
    point.expected = std::exchange(point.pose, found);
    compare(now, point);
    if (point.isSeen() && !(point.fit.correlation >= found_correlation_ && point.fit.share >= found_share_))
      point.reason = Reason::kNotSeen;
    point.pose = point.isSeen() ? point.fit.pose : point.expected;
    if (point.isSeen()) point.followed = false;
  }
}

}  // namespace laparoscope_servo::features
