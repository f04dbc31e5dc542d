// Which pixels of the region of interest (ROI) can be compared at all: valid ones that are saturated neither in the
// image nor in the reference, nor lie beside such a highlight.
#pragma once

#include <array>
#include <opencv2/core.hpp>
#include <vector>

#include "laparoscope_servo/image/area_grid.h"
#include "laparoscope_servo/image/colour_patch.h"
#include "laparoscope_servo/image/patch.h"
#include "laparoscope_servo/tracking/area_report.h"

namespace laparoscope_servo::tracking {

class HighlightMask {
 public:
  // `saturation` [grey levels]: from it on a pixel counts as saturated.
  explicit HighlightMask(int saturation) : saturation_(saturation) {}

  // `patch`: every `step`-th pixel of the reference's ROI, in rows and columns. `size`: of the ROI. `samples`: the
  // ROI's areas in such a patch. `tracked`: the channels (blue, green, red) to which the saturation applies.
  void setReference(const image::ColourPatch& patch, const cv::Size& size, const image::AreaGrid& samples, int step,
                    const std::array<bool, 3>& tracked);
  // After setReference(): what is not 0 in `covered`, which has the size of that patch, is never used.
  void hideInReference(const cv::Mat1b& covered);
  // `patch`: of the current image, sampled with the same step.
  void observe(const image::ColourPatch& patch);

  // 1 for each pixel of the ROI that can be compared, else 0.
  const image::Patch& usable() const { return usable_; }
  // Why half of an area's samples or more cannot be compared: kBorder (not valid) or kHighlight; otherwise kNone.
  AreaCause hidden(int area) const;

 private:
  void mark(const image::ColourPatch& patch, cv::Mat1b& saturated) const;
  void spread();

  int saturation_;
  std::array<int, 3> limits_ = {256, 256, 256};  // grey levels: saturation of each channel; 256: none
  int step_ = 1;
  image::AreaGrid samples_;
  cv::Mat1b reference_saturated_, saturated_;  // 255 or 0 per sample
  cv::Mat1b valid_;                            // 255 per sample in the image, or 0
  image::Patch usable_;
  std::vector<float> row_;
};

}  // namespace laparoscope_servo::tracking
