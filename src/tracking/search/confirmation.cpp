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
// s, for which a candidate waits in images in which it is not found. Where an instrument hides most of a region it is
// found in one image of three.
constexpr double kPatience = 0.2;

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

bool Confirmation::add(const Evidence& found, double stamp) {
  const EsmResult& estimate = found.esm;
  // The target may move at a steady speed, so the expected place includes the last step.
  if (count_ > 0) {
    const double apart = geometry::cornerDistance(expected(), estimate.state.g, found.roi);
    const double share = count_ == 1 || missed_ ? kUnknownMotion : 0.0;
    const double unknown = share * std::hypot(found.roi.width, found.roi.height);
    const double allowed = allowedJump(found.record, config_, found.roi, 0.0, estimate.corner_error);
    const bool proven = !missed_ || recognised(found);
    if (!(apart <= std::max(allowed, unknown)) || !proven) count_ = 0;
  }
  const bool moves = count_ > 0 && !missed_;
  step_ = moves ? Eigen::Matrix3d(candidate_.g.inverse() * estimate.state.g) : Eigen::Matrix3d::Identity();
  ++count_;
  missed_ = false;
  stamp_ = stamp;
  candidate_ = estimate.state;
  return count_ >= config_.confirmations;
}

void Confirmation::miss(double stamp) {
  missed_ = true;
  step_.setIdentity();
  if (!(stamp - stamp_ < kPatience)) count_ = 0;
}

}  // namespace laparoscope_servo::tracking
