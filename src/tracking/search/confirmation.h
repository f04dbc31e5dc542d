// What a search has found is believed when it stays: false fits do not come back to the same place, nor go on as they
// went.
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
  // It was not found, or is believed.
  void forget() { count_ = 0; }

  // Something was found in the image before, and waits.
  bool waiting() const { return count_ > 0; }
  // That; the last one there was, when none waits.
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
