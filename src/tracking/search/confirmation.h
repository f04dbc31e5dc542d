// Confirms the result of a search: the ROI must be found again soon, at the same place or moving steadily. False fits
// are not found again. If it was missed in between, its blocks must prove it (see recognised()): a false fit that comes
// and goes may return to its place.
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

  // Call if the ROI was found in the image of `stamp` [s]. Returns true once this was QualityConfig::confirmations
  // images, each of them at most 0.2 s after the one before.
  bool add(const Evidence& found, double stamp);
  // Call if the ROI was not found in the image of `stamp` [s]: the count starts again if that is so for too long.
  void miss(double stamp);
  // Call if the ROI has been confirmed: the count starts again.
  void forget() { count_ = 0; }

  // Whether the ROI was found lately and is not confirmed yet.
  bool waiting() const { return count_ > 0; }
  // Whether it was found in the image before.
  bool justFound() const { return waiting() && !missed_; }
  // The estimate of the last image in which the ROI was found.
  const EsmState& candidate() const { return candidate_; }
  // The candidate as it is expected in the next image, at constant motion if that is known; empty if none waits.
  // Determinant of G: 1.
  std::optional<EsmState> awaited() const;

 private:
  Eigen::Matrix3d expected() const;

  QualityConfig config_;
  int count_ = 0;
  bool missed_ = false;  // in the last image
  double stamp_ = 0.0;   // s, of the image in which it was found last
  EsmState candidate_;
  Eigen::Matrix3d step_ = Eigen::Matrix3d::Identity();  // motion from the image before
};

}  // namespace laparoscope_servo::tracking
