// Masks of what covers the tissue, as another node tells them: kept until the images come for which they can be used.
//
// The mask of an image usually comes after that image, and nobody waits for it. Then the newest earlier one is used as
// predicted: grown by what it gained on the one before it, for the time that has passed since.
//
// Masks are CV_8UC1, not 0 where the tissue is covered; times are seconds, from the images' stamps. No clock, not
// thread-safe.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <opencv2/core.hpp>
#include <vector>

#include "laparoscope_servo/geometry/homography.h"

namespace laparoscope_servo::tracking {

struct ExternalMask {
  cv::Mat mask;        // empty: nothing is known. Valid until the next call of ExternalMasks
  double age = 0.0;    // s, from the mask's own image to the one that it is used for; 0: it is of that image
  double grown = 0.0;  // px
};

class ExternalMasks {
 public:
  // `max_age`: s, an older mask is not used; 0: only that of the image itself is.
  explicit ExternalMasks(double max_age) : max_age_(max_age) {}

  // The mask of the image at `stamp`, which is after those of all masks before it, or replaces all of them. It is not
  // copied: `holder`, if there is one, keeps its pixels.
  void add(const cv::Mat& mask, double stamp, std::shared_ptr<const void> holder = nullptr);

  // For the image at `stamp`, of `size`. A mask of another size is not used.
  ExternalMask at(double stamp, const cv::Size& size);

  void clear();

 private:
  struct Kept {
    cv::Mat mask;  // empty: none
    double stamp = 0.0;
    std::shared_ptr<const void> holder;
  };

  const Kept& recent(std::size_t back) const { return kept_[(next_ + kept_.size() - 1 - back) % kept_.size()]; }
  double speed(std::size_t back);
  void reduce(const cv::Mat& mask, cv::Mat1b& cells);

  double max_age_;
  std::array<Kept, 8> kept_;  // more than images wait for a tracker that is late
  std::size_t next_ = 0;      // where the next one goes
  cv::Mat1b covered_, older_, newer_, grown_;
  cv::Mat1f distance_;
  std::vector<float> gained_;
};

// 0 to 1: of a region with these corners [px, of the mask], by a grid of points. Points outside of the mask are not
// covered. 0 without a mask.
double coveredShare(const cv::Mat& mask, const geometry::Quadrilateral& corners);

}  // namespace laparoscope_servo::tracking
