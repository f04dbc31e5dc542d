// Confirms what a search has found: it has to be found again in the next images, at the same place or moving steadily.
// False fits are not.
#pragma once

#include <Eigen/Core>

#include "tracking/align/quality.h"
#include "tracking/esm/esm.h"

namespace laparoscope_servo::tracking {

class Confirmation {
 public:
  explicit Confirmation(const QualityConfig& config) : config_(config) {}

  // See RegionTracker::retune.
  void retune(const QualityConfig& config) { config_ = config; }

  // The ROI was found in the next image. True when that is often enough: QualityConfig::confirmations images in a row.
  bool add(const EsmResult& found, const geometry::Rectangle& roi, const TrackRecord& record);
  // Starts again: the ROI was not found, or has been confirmed.
  void forget() { count_ = 0; }

  // The ROI was found in the image before and is not confirmed yet.
  bool waiting() const { return count_ > 0; }
  // The estimate of the last image in which the ROI was found.
  const EsmState& candidate() const { return candidate_; }
  // Where it is in the next image, if it goes on as it went; determinant 1.
  Eigen::Matrix3d expected() const;

 private:
  QualityConfig config_;
  int count_ = 0;
  EsmState candidate_;
  Eigen::Matrix3d step_ = Eigen::Matrix3d::Identity();  // by which it came from the image before
};

}  // namespace laparoscope_servo::tracking
