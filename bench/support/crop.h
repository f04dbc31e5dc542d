// The part of an image that a peer is given, so that none of them pays for pixels it does not need.
#pragma once

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>

#include "laparoscope_servo/geometry/homography.h"

namespace laparoscope_servo::bench {

// The box around the ROI as `g` shows it, with `margin` px on each side, cut to the image; empty where there is none.
inline cv::Rect boxAround(const Eigen::Matrix3d& g, const geometry::Rectangle& roi, double margin,
                          const cv::Size& image) {
  const geometry::Quadrilateral corners = geometry::apply(g, roi.corners());
  Eigen::Vector2d low = corners[0], high = corners[0];
  for (const Eigen::Vector2d& corner : corners) {
    if (!corner.allFinite() || !(corner.cwiseAbs().maxCoeff() < 1e6)) return {};
    low = low.cwiseMin(corner);
    high = high.cwiseMax(corner);
  }
  const cv::Point first(static_cast<int>(std::floor(low.x() - margin)), static_cast<int>(std::floor(low.y() - margin)));
  const cv::Point last(static_cast<int>(std::ceil(high.x() + margin)) + 1,
                       static_cast<int>(std::ceil(high.y() + margin)) + 1);
  return cv::Rect(first, last) & cv::Rect(cv::Point(0, 0), image);
}

}  // namespace laparoscope_servo::bench
