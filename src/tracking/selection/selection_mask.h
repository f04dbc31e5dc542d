// What of an image no region that is selected in it may use: what is known to cover the tissue, what instruments cover,
// and what lies beyond the endoscope's field of view.
#pragma once

#include <opencv2/core.hpp>

#include "laparoscope_servo/geometry/homography.h"
#include "laparoscope_servo/image/field_mask.h"
#include "laparoscope_servo/image/lens.h"

namespace laparoscope_servo::tracking {

class SelectionMask {
 public:
  // `external`: CV_8UC1 of the image's size, not 0 where the tissue is known to be covered; empty: nothing is known.
  SelectionMask(const cv::Mat& image, const cv::Mat& external);

  // CV_8UC1 of the image's size, not 0 where it may not be used; empty: all of it may.
  const cv::Mat& mask() const { return mask_; }

  // Throws std::invalid_argument when most of the ROI lies beyond the field of view, or on an instrument. With a lens
  // (null: none) the ROI is in rectified pixels, and the image is raw.
  void check(const geometry::Rectangle& roi, const image::Lens* lens) const;

 private:
  image::FieldMask field_;
  cv::Mat instruments_;  // empty: none
  cv::Mat mask_;
};

}  // namespace laparoscope_servo::tracking
