// Grey levels along the normal of a site, each the mean over some samples across it.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <opencv2/core.hpp>

#include "laparoscope_servo/features/curve.h"

namespace laparoscope_servo::features {

// The mask: along the normal it takes kReach samples either side, across it the mean of 2 kHalfWidth + 1, or of every
// other one of them.
struct EdgeWindow {
  double range = 20.0;    // px, either side of the site
  double step = 1.0;      // px between samples, along and across; the mask grows with it
  int across_stride = 1;  // 1: every sample across the normal; 2: every other one
};

class EdgeProfile {
 public:
  static constexpr int kReach = 2;
  static constexpr int kHalfWidth = 2;

  // Of the luma of a CV_8UC1 or CV_8UC3 image. False where the image has no pixels for the least profile.
  bool read(const cv::Mat& image, const Site& site, const EdgeWindow& window);

  // Sample k lies at site + (first() + k) step normal.
  int first() const { return first_; }
  int count() const { return count_; }
  const float* levels() const { return levels_.data(); }

 private:
  static constexpr int kMost = 256;  // samples

  std::array<float, kMost> levels_{};
  int first_ = 0;
  int count_ = 0;
  // Of every sample, row after row: upper left of the four neighbours, as a distance from the image's first byte; the
  // place between them; their levels, a byte each.
  static constexpr int kSamples = (2 * kHalfWidth + 1) * kMost;
  std::array<std::int32_t, kSamples> offset_{};
  std::array<float, kSamples> right_of_{}, below_{};
  std::array<std::uint32_t, kSamples> neighbours_{};
};

}  // namespace laparoscope_servo::features
