// Points of texture behind the interface of all trackers: PointTracker, each point with an id.
#pragma once

#include <string>
#include <vector>

#include "laparoscope_servo/features/feature_tracker.h"
#include "laparoscope_servo/features/points.h"

namespace laparoscope_servo::features {

class PointFeatureTracker : public FeatureTracker {
 public:
  // Throws std::invalid_argument that lists every error of the configuration.
  explicit PointFeatureTracker(const PointsConfig& config = {}) : config_(config), tracker_(config) { tell(); }

  // Corners become features of their own, with the ids "ID 1", "ID 2", ..., the strongest first. Of points that are
  // given in a stored picture, the desired values are their places there unless others are given.
  const TrackedFeatures& select(const cv::Mat& image, double stamp, const FeatureSelection& selection,
                                const FeaturePrior& prior) override;
  const TrackedFeatures& track(const cv::Mat& image, double stamp, const FeaturePrior& prior) override;
  void reset() override;
  const TrackedFeatures& features() const override { return told_; }

 private:
  void tell();

  PointsConfig config_;
  PointTracker tracker_;
  TrackedFeatures told_;
};

}  // namespace laparoscope_servo::features
