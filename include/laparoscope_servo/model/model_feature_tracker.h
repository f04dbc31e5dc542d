// Models behind the interface of all trackers: a ModelTracker for each object, with an id; all of one shape.
#pragma once

#include <memory>
#include <vector>

#include "laparoscope_servo/features/feature_tracker.h"
#include "laparoscope_servo/model/model_tracker.h"

namespace laparoscope_servo::model {

class ModelFeatureTracker : public features::FeatureTracker {
 public:
  // Throws std::invalid_argument that lists every error of the configuration.
  explicit ModelFeatureTracker(std::shared_ptr<const CadModel> model, const ModelConfig& config = {});

  // Each feature is a POSE, with the pose about which it is looked for. The prior has to have the camera. What is told
  // of it has for outline the convex hull of its sites.
  const features::TrackedFeatures& select(const cv::Mat& image, double stamp,
                                          const features::FeatureSelection& selection,
                                          const features::FeaturePrior& prior) override;
  // Of the prior's motions that in space is used. Another camera than that of the selection resets.
  const features::TrackedFeatures& track(const cv::Mat& image, double stamp,
                                         const features::FeaturePrior& prior) override;
  void reset() override;
  const features::TrackedFeatures& features() const override { return told_; }
  bool givesPoses() const override { return true; }

 private:
  void end(const char* reason);
  void tell();

  std::shared_ptr<const CadModel> model_;
  ModelConfig config_;
  geometry::PinholeCamera camera_;
  std::vector<ModelTracker> trackers_;  // in the order of told_.features
  features::TrackedFeatures told_;
  std::vector<Eigen::Vector2d> points_;  // px, of the sites of one object
};

}  // namespace laparoscope_servo::model
