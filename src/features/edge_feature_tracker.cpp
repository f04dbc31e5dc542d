#include "laparoscope_servo/features/edge_feature_tracker.h"

#include <stdexcept>
#include <utility>

#include "features/tracked_curve.h"
#include "laparoscope_servo/features/selection_check.h"
#include "laparoscope_servo/validation/error_report.h"

namespace laparoscope_servo::features {

EdgeFeatureTracker::EdgeFeatureTracker(const EdgeConfig& config) : config_(config) {
  validation::throwErrors("edges", validate(config));
  summarise(told_, reasonText(Reason::kNothingSelected));
}

EdgeFeatureTracker::~EdgeFeatureTracker() = default;

const TrackedFeatures& EdgeFeatureTracker::select(const cv::Mat& image, double stamp, const FeatureSelection& selection,
                                                  const FeaturePrior&) {
  validation::throwErrors("selection",
                          validate(selection, {FeatureKind::kLine, FeatureKind::kEllipse, FeatureKind::kSpline}));
  if (selection.empty()) throw std::invalid_argument("selection: 0 features, expected at least 1");
  std::vector<std::unique_ptr<TrackedCurve>> curves;
  for (const SelectedFeature& selected : selection) {
    curves.push_back(makeTrackedCurve(selected.kind, config_));
    try {
      checkInImage(selected, image.size());
      curves.back()->select(image, stamp, selected);
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument(selected.id + ": " + error.what());
    }
  }
  curves_ = std::move(curves);
  begin(told_, selection);
  for (TrackedFeature& told : told_.features) told.sites.reserve(static_cast<std::size_t>(config_.max_sites));
  tell();
  return told_;
}

const TrackedFeatures& EdgeFeatureTracker::track(const cv::Mat& image, double stamp, const FeaturePrior& prior) {
  for (const std::unique_ptr<TrackedCurve>& curve : curves_) curve->track(image, stamp, prior.motion);
  tell();
  return told_;
}

void EdgeFeatureTracker::reset() {
  curves_.clear();
  told_.features.clear();
  summarise(told_, reasonText(Reason::kReset));
}

// An image that is not of the sequence ends all of them, since all see the same ones.
void EdgeFeatureTracker::tell() {
  std::string ended = told_.features.empty() ? told_.reason : "";
  for (std::size_t k = 0; k < told_.features.size(); ++k) {
    TrackedFeature& told = told_.features[k];
    curves_[k]->tell(told);
    if (told.state == State::kIdle) ended = told.reason;
  }
  if (!ended.empty()) {
    curves_.clear();
    told_.features.clear();
  }
  summarise(told_, ended);
}

}  // namespace laparoscope_servo::features
