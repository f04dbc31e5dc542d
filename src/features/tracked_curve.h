// A curve of any kind, tracked by its edges: what the tracker of edges has a list of.
//
// Another kind of curve needs a curveOf() and a tellCurve() of its own, and its line in makeTrackedCurve().
#pragma once

#include <Eigen/Core>
#include <memory>
#include <opencv2/core.hpp>
#include <optional>

#include "laparoscope_servo/features/edge_config.h"
#include "laparoscope_servo/features/feature_selection.h"
#include "laparoscope_servo/features/tracked_feature.h"

namespace laparoscope_servo::features {

class TrackedCurve {
 public:
  virtual ~TrackedCurve() = default;
  // As CurveTracker has them.
  virtual void select(const cv::Mat& image, double stamp, const SelectedFeature& selected) = 0;
  virtual void track(const cv::Mat& image, double stamp, const std::optional<Eigen::Matrix3d>& motion) = 0;
  // All but id and desired values.
  virtual void tell(TrackedFeature& told) const = 0;
};

// Throws std::invalid_argument for a kind that is no curve.
std::unique_ptr<TrackedCurve> makeTrackedCurve(FeatureKind kind, const EdgeConfig& config);

}  // namespace laparoscope_servo::features
