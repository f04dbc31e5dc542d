#include "tracking/search/confirmation.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "laparoscope_servo/geometry/sl3.h"
#include "tracking/align/region_aligner.h"

namespace laparoscope_servo::tracking {

namespace {

// Share of the ROI's diagonal by which a region of unknown motion may move until the next image.
constexpr double kUnknownMotion = 0.15;

}  // namespace

Eigen::Matrix3d Confirmation::expected() const {
  return geometry::normaliseDeterminant(candidate_.g * step_);
}

std::optional<EsmState> Confirmation::awaited() const {
  if (!waiting()) return std::nullopt;
  EsmState state = candidate_;
  state.g = expected();
  return state;
}

bool Confirmation::add(const EsmResult& found, const geometry::Rectangle& roi, const TrackRecord& record) {
  // The target may move at a steady speed, so the expected place includes the last step.
  if (count_ > 0) {
    const double apart = geometry::cornerDistance(expected(), found.state.g, roi);
    const double share = count_ == 1 ? kUnknownMotion : 0.0;
    const double unknown = share * std::hypot(roi.width, roi.height);
    const double allowed = allowedJump(record, config_, roi, 0.0, found.corner_error);
    if (!(apart <= std::max(allowed, unknown))) count_ = 0;
  }
  step_ = count_ > 0 ? Eigen::Matrix3d(candidate_.g.inverse() * found.state.g) : Eigen::Matrix3d::Identity();
  ++count_;
  candidate_ = found.state;
  return count_ >= config_.confirmations;
}

}  // namespace laparoscope_servo::tracking
