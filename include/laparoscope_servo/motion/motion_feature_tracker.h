// Dominant motion behind the interface of all trackers, as features of kind MOTION.
//
// A feature's parameters are a0 to a1, a5 or a7 of eq. (8), as many as the model has, about the image's centre: px, 1,
// 1/px. What can be selected is one feature of kind MOTION:
// - nothing: "motion" is the motion from the last image to this one;
// - ID with two opposite corners of a region: so is ID, of the region, which goes along with its motion;
// - ID without points: that image is the anchor (see AnchoredMotion). ID is the field whose flow takes it to this
// image,
//   its outline where it is now, and "ID step" the motion from the last image to this one.
#pragma once

#include <optional>

#include "laparoscope_servo/features/feature_tracker.h"
#include "laparoscope_servo/motion/anchored_motion.h"
#include "laparoscope_servo/motion/dominant_motion.h"

namespace laparoscope_servo::motion {

class MotionFeatureTracker : public features::FeatureTracker {
 public:
  // Throws std::invalid_argument that lists every error of the configuration.
  explicit MotionFeatureTracker(const MotionConfig& config = {});

  const features::TrackedFeatures& select(const cv::Mat& image, double stamp,
                                          const features::FeatureSelection& selection,
                                          const features::FeaturePrior& prior) override;
  const features::TrackedFeatures& track(const cv::Mat& image, double stamp,
                                         const features::FeaturePrior& prior) override;
  void reset() override;
  const features::TrackedFeatures& features() const override { return told_; }
  bool findsByItself() const override { return true; }
  bool takesSelection() const override { return true; }
  bool givesMask() const override { return true; }
  // 255 where the texture does not follow the motion from the last image, by cells of DominantMotion::support().
  cv::Mat mask() const override;

 private:
  void begin(const features::FeatureSelection& selection);
  void tell();
  void tellStep(const MotionResult& result, features::TrackedFeature& told) const;
  void tellAnchored(const AnchoredResult& result, features::TrackedFeature& told) const;

  MotionConfig config_;
  int parameters_;
  DominantMotion motion_;
  std::optional<AnchoredMotion> anchored_;  // in place of motion_, while an image is selected
  cv::Size size_;                           // of the last image
  features::TrackedFeatures told_;
};

}  // namespace laparoscope_servo::motion
