// Confirms the result of a search: the ROI must be found again in the next images, at the same place or moving
// steadily. False fits are not found again.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "tracking/align/quality.h"
#include "tracking/esm/esm.h"

namespace laparoscope_servo::tracking {

class Confirmation {
 public:
  explicit Confirmation(const QualityConfig& config) : config_(config) {}

  // See RegionTracker::retune.
  void retune(const QualityConfig& config) { config_ = config; }

  // Call if the ROI was found in the image. Returns true once this was QualityConfig::confirmations images in a row.
  bool add(const EsmResult& found, const geometry::Rectangle& roi, const TrackRecord& record);
  // Call if the ROI was not found, or has been confirmed: the count starts again.
  void forget() { count_ = 0; }

  // Whether the ROI was found in the last image and is not confirmed yet.
  bool waiting() const { return count_ > 0; }
  // The estimate of the last image in which the ROI was found.
  const EsmState& candidate() const { return candidate_; }
  // The candidate as it is expected in the next image, at constant motion; empty if none waits. Determinant of G: 1.
  std::optional<EsmState> awaited() const;

 private:
  Eigen::Matrix3d expected() const;

  QualityConfig config_;
  int count_ = 0;
  EsmState candidate_;
  Eigen::Matrix3d step_ = Eigen::Matrix3d::Identity();  // motion from the image before
};

}  // namespace laparoscope_servo::tracking
