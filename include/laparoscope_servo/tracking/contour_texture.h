// Contour and texture in one minimisation (Marchand and Chaumette 2004, II.D): a thing with a closed outline, taken for
// a plane, followed by the grey levels inside of it and by the edges along it. The homography minimises ESM's residuals
// and the distances of the edges from the contour together, each weighted by a robust scale of its own: where either
// shows little, the other decides.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "laparoscope_servo/features/edge_config.h"
#include "laparoscope_servo/features/feature_tracker.h"

namespace laparoscope_servo::tracking {

struct ContourTextureConfig {
  bool texture = true;            // the grey levels inside of the contour count
  bool contour = true;            // the edges along it count; one of the two has to
  double min_block_share = 0.35;  // of the blocks with texture, that correlate with the reference
  double min_correlation = 0.6;   // of a block that does
  double max_corner_error = 1.5;  // px: expected standard deviation of the worst corner of the contour's box
  features::EdgeConfig edges;
};

// Rows for all of it: ranges and meanings.
void describe(parameters::Table& table, ContourTextureConfig& config);
// Every error, each naming the field, its value and what was expected. Empty when the configuration can be used.
std::vector<std::string> validate(const ContourTextureConfig& config);

// One feature, of kind MOTION: h00 h01 h02 h10 h11 h12 h20 h21 of the homography H with h22 = 1, that takes pixels of
// the image of the selection to pixels of this one. It is selected by a closed spline, points on the outline in their
// order. The outline that is told is the contour where it is; the share is that of the edges, or of the blocks of
// texture, that agree: the larger one. For its conventions see FeatureTracker.
class ContourTextureTracker : public features::FeatureTracker {
 public:
  // Throws std::invalid_argument that lists every error of the configuration.
  explicit ContourTextureTracker(const ContourTextureConfig& config = {});
  ~ContourTextureTracker() override;

  const features::TrackedFeatures& select(const cv::Mat& image, double stamp,
                                          const features::FeatureSelection& selection,
                                          const features::FeaturePrior& prior) override;
  const features::TrackedFeatures& track(const cv::Mat& image, double stamp,
                                         const features::FeaturePrior& prior) override;
  void reset() override;
  const features::TrackedFeatures& features() const override;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace laparoscope_servo::tracking
