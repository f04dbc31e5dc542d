// Lines, ellipses and splines behind the interface of all trackers: a CurveTracker for each, with an id.
#pragma once

#include <memory>
#include <vector>

#include "laparoscope_servo/features/edge_config.h"
#include "laparoscope_servo/features/feature_tracker.h"

namespace laparoscope_servo::features {

class TrackedCurve;

class EdgeFeatureTracker : public FeatureTracker {
 public:
  // Throws std::invalid_argument that lists every error of the configuration.
  explicit EdgeFeatureTracker(const EdgeConfig& config = {});
  ~EdgeFeatureTracker() override;

  const TrackedFeatures& select(const cv::Mat& image, double stamp, const FeatureSelection& selection,
                                const FeaturePrior& prior) override;
  const TrackedFeatures& track(const cv::Mat& image, double stamp, const FeaturePrior& prior) override;
  void reset() override;
  const TrackedFeatures& features() const override { return told_; }

 private:
  void tell();

  EdgeConfig config_;
  std::vector<std::unique_ptr<TrackedCurve>> curves_;  // in the order of told_.features
  TrackedFeatures told_;
};

}  // namespace laparoscope_servo::features
