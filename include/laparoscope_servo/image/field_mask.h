// What of an image lies beyond the endoscope's field of view. Its border stands still in the image while the tissue
// moves, and is the strongest edge of the picture: a region across it would be held by the border.
#pragma once

#include <opencv2/core.hpp>

#include "laparoscope_servo/image/field_of_view.h"

namespace laparoscope_servo::image {

class FieldMask {
 public:
  // Finds the field of view of an image, CV_8UC1 or CV_8UC3. An image that is black all over has none, and nothing of
  // it counts as beyond.
  void look(const cv::Mat& image);

  // Nothing of the image that look() was given is beyond.
  bool isWhole() const { return whole_; }
  // The rectangle [px] lies within the field of view, and not near to its border.
  bool contains(const cv::Rect& box) const;
  // Share of the rectangle [px], within the image, that is beyond: 0 to 1.
  double shareBeyond(const cv::Rect& box) const;

  // CV_8UC1 of the image's size: 255 where it is beyond, or where `mask` (of this size, or empty) is not 0; else 0.
  // With nothing beyond `mask` itself. The buffer is reused by the next call.
  const cv::Mat& joined(const cv::Mat& mask);

 private:
  cv::Range within(int y) const;

  FieldOfView view_;  // of cells
  cv::Mat1b cells_;
  cv::Size size_;  // px, of the image
  int step_ = 1;   // px of the image per cell
  bool whole_ = true;
  cv::Mat joined_;
};

}  // namespace laparoscope_servo::image
