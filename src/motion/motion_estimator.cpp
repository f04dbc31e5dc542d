#include "motion/motion_estimator.h"

#include <algorithm>
#include <optional>

namespace laparoscope_servo::motion {

namespace {

using features::Reason;

constexpr double kInView = 0.25;        // least share of the region's area that is in the image
constexpr double kLeastTexture = 0.02;  // least share of the cells that have enough texture

}  // namespace

void MotionEstimator::setReference(const MotionImage& image) {
  aligner_.setReference(image);
}

void MotionEstimator::forget() {
  expected_.fill(0.0);
  support_.clear();
}

Reason MotionEstimator::judge(const MotionImage& reference, const MotionImage& current,
                              const std::vector<Eigen::Matrix3d>& starts, const geometry::Quadrilateral& region,
                              bool whole) {
  const JointUse use = aligner_.setUsable(reference, current, starts.front(), whole ? nullptr : &region);
  found_.usable = use.usable;
  if (!whole && !(use.within > kInView * geometry::signedArea(region))) return Reason::kOutside;
  if (!(use.usable >= config_.min_usable)) return Reason::kNothingUsable;
  found_.at = aligner_.align(current, starts, expected_);
  if (!found_.at.determined) return Reason::kNoTexture;
  const std::optional<tracking::Matrix8d> covariance = aligner_.covariance();
  support_.judge(aligner_, current, found_.at);
  found_.share = support_.share();
  if (!covariance ||
      support_.textured() < kLeastTexture * use.within / (aligner_.frame().width * aligner_.frame().height))
    return Reason::kNoTexture;
  if (!(found_.share >= config_.min_share)) return Reason::kNothingDominates;
  found_.covariance = *covariance;
  found_.expected_error = errorAtCorners(region, aligner_.frame().centre(), found_.covariance);
  return found_.expected_error <= config_.max_error ? Reason::kNone : Reason::kUncertain;
}

// The residuals of the next image are expected to be as large as those of the part that follows the motion in this one.
void MotionEstimator::expectScales() {
  expected_ = aligner_.scales();
  const double found = expected_[static_cast<std::size_t>(support_.level())];
  for (double& scale : expected_) scale *= support_.sigma() / std::max(found, 1e-9);
}

const MotionEstimate& MotionEstimator::estimate(const MotionImage& reference, const MotionImage& current,
                                                const std::vector<Eigen::Matrix3d>& starts,
                                                const geometry::Quadrilateral& region, bool whole) {
  found_ = MotionEstimate();
  const bool knew = expected_.front() > 0.0;
  found_.why = judge(reference, current, starts, region, whole);
  if (found_.why == Reason::kNone) expectScales();
  if (found_.why == Reason::kNone && !knew) {
    // Estimates once more from there: the scale of the residuals is known now.
    again_.assign(1, found_.at.g);
    found_.why = judge(reference, current, again_, region, whole);
  }
  if (found_.why != Reason::kNone) forget();
  return found_;
}

}  // namespace laparoscope_servo::motion
