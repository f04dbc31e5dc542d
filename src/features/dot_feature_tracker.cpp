#include "laparoscope_servo/features/dot_feature_tracker.h"

#include <cmath>
#include <stdexcept>

#include "laparoscope_servo/features/selection_check.h"
#include "laparoscope_servo/validation/error_report.h"

namespace laparoscope_servo::features {

namespace {

constexpr std::size_t kOutlinePoints = 24;

}  // namespace

const TrackedFeatures& DotFeatureTracker::select(const cv::Mat& image, double stamp, const FeatureSelection& selection,
                                                 const FeaturePrior&) {
  validation::throwErrors("selection", validate(selection, {FeatureKind::kPoint}));
  std::vector<Eigen::Vector2d> points;
  for (const SelectedFeature& feature : selection) points.push_back(feature.points.front());
  try {
    tracker_.select(image, stamp, points);
  } catch (const RefusedFeature& error) {
    throw std::invalid_argument(selection[error.index()].id + ": " + error.what());
  }
  begin(told_, selection);
  for (TrackedFeature& told : told_.features) told.outline.resize(kOutlinePoints + 1);
  tell();
  return told_;
}

const TrackedFeatures& DotFeatureTracker::track(const cv::Mat& image, double stamp, const FeaturePrior& prior) {
  tracker_.track(image, stamp, prior.motion);
  tell();
  return told_;
}

void DotFeatureTracker::reset() {
  tracker_.reset();
  tell();
}

void DotFeatureTracker::tell() {
  const DotsResult& result = tracker_.result();
  if (result.state == State::kIdle) told_.features.clear();
  for (std::size_t k = 0; k < told_.features.size(); ++k) {
    const DotResult& dot = result.dots[k];
    TrackedFeature& told = told_.features[k];
    told.state = dot.state;
    told.reason = reasonText(dot.reason);
    told.parameters = dot.centre;
    told.covariance = dot.covariance;
    told.share = dot.state == State::kTracking ? 1.0 : 0.0;
    told.expected_error = dot.expected_error;
    const double radius = std::sqrt(dot.area / M_PI);
    for (std::size_t i = 0; i <= kOutlinePoints; ++i) {
      const double phi = 2.0 * M_PI * static_cast<double>(i) / kOutlinePoints;
      told.outline[i] = dot.centre + radius * Eigen::Vector2d(std::cos(phi), std::sin(phi));
    }
  }
  summarise(told_, reasonText(result.reason));
}

}  // namespace laparoscope_servo::features
