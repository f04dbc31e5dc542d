// Dots behind the interface of all trackers: DotTracker, each dot with an id.
#pragma once

#include <string>
#include <vector>

#include "laparoscope_servo/features/dots.h"
#include "laparoscope_servo/features/feature_tracker.h"

namespace laparoscope_servo::features {

class DotFeatureTracker : public FeatureTracker {
 public:
  // Throws std::invalid_argument that lists every error of the configuration.
  explicit DotFeatureTracker(const DotsConfig& config = {}) : tracker_(config) { tell(); }

  const TrackedFeatures& select(const cv::Mat& image, double stamp, const FeatureSelection& selection,
                                const FeaturePrior& prior) override;
  const TrackedFeatures& track(const cv::Mat& image, double stamp, const FeaturePrior& prior) override;
  void reset() override;
  const TrackedFeatures& features() const override { return told_; }

 private:
  void tell();

  DotTracker tracker_;
  TrackedFeatures told_;
};

}  // namespace laparoscope_servo::features
