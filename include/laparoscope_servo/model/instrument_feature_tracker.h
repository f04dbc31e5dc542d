// Instruments behind the interface of all trackers: found without a selection, each told as several features.
//
// Of instrument K: the lines "K right" and "K left" as far as they are seen, the point "K tip", and the pose "K" where
// radius and camera are known: of a frame at CylinderPose's point, whose z axis points along the shaft to the tip, with
// the covariance of CylinderPose. A line's share is 1 where it was fitted to the image's edges, 0 where only to the
// outline of what is grey. Allocates when instruments come and go.
#pragma once

#include "laparoscope_servo/features/feature_tracker.h"
#include "laparoscope_servo/model/instruments.h"

namespace laparoscope_servo::model {

class InstrumentFeatureTracker : public features::FeatureTracker {
 public:
  // Throws std::invalid_argument that lists every error of the configuration.
  explicit InstrumentFeatureTracker(const InstrumentConfig& config = {});

  // Throws std::invalid_argument: nothing can be selected.
  const features::TrackedFeatures& select(const cv::Mat& image, double stamp,
                                          const features::FeatureSelection& selection,
                                          const features::FeaturePrior& prior) override;
  const features::TrackedFeatures& track(const cv::Mat& image, double stamp,
                                         const features::FeaturePrior& prior) override;
  void reset() override;
  const features::TrackedFeatures& features() const override { return told_; }
  bool findsByItself() const override { return true; }
  bool givesPoses() const override { return true; }
  bool givesMask() const override { return true; }
  cv::Mat mask() const override { return tracker_.result().mask; }

 private:
  void tell();
  features::TrackedFeature& add(const Instrument& instrument, const char* part, features::FeatureKind kind);
  void addEdge(const Instrument& instrument, std::size_t side);
  void addTip(const Instrument& instrument);
  void addPose(const Instrument& instrument);

  InstrumentTracker tracker_;
  double radius_;  // m
  features::TrackedFeatures told_;
  std::size_t count_ = 0;  // of the features that the present image has so far
};

}  // namespace laparoscope_servo::model
