// The part of an image by which the motion of a region is estimated: the region with a margin on each side. The levels
// of its pyramid go with the size of the region. On those of the whole image a small region would have no pixels left.
#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "laparoscope_servo/geometry/homography.h"

namespace laparoscope_servo::motion {

// Takes pixels of the box to those of the image.
Eigen::Matrix3d imageFromBox(const cv::Rect& box);
// Of the box's pixels, px of the image.
Eigen::Vector2d middleOf(const cv::Rect& box);

class RegionWindow {
 public:
  RegionWindow() = default;
  // `region`: px, within an image of size `image`, which is at least 64 px in width and height.
  RegionWindow(const geometry::Rectangle& region, const cv::Size& image);

  // The window about the region where it is now. Of one size for all images, so that nothing is allocated; within the
  // image. A region that has grown beyond the window is seen in part.
  cv::Rect about(const geometry::Quadrilateral& region) const;

 private:
  cv::Size size_, image_;
};

}  // namespace laparoscope_servo::motion
