// An image as the tracker of points sees it: a smoothed pyramid, and which pixels are not to be compared.
#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "laparoscope_servo/image/pyramid.h"

namespace laparoscope_servo::features {

class PointImage {
 public:
  // `levels` at most, fewer for a small image. `saturation`: pixels as bright in any channel, and those up to 2 px from
  // them, are not usable. `image`: CV_8UC1 or CV_8UC3. Buffers are reused.
  void take(const cv::Mat& image, int levels, int saturation);

  int levels() const { return pyramid_.levels(); }
  const cv::Mat1f& level(int l) const { return pyramid_.level(l); }
  cv::Size size() const { return usable_.size(); }
  // 1 or 0, of the image's size.
  const cv::Mat1b& usable() const { return usable_; }
  // Of the pixel next to p; false outside of the image, and for NaN.
  bool isUsable(double x, double y) const {
    if (!(x > -0.5 && y > -0.5 && x < usable_.cols - 0.5 && y < usable_.rows - 0.5)) return false;
    return usable_(static_cast<int>(y + 0.5), static_cast<int>(x + 0.5)) != 0;
  }
  bool holds(const Eigen::Vector2d& p) const {
    return p.x() >= 0.0 && p.y() >= 0.0 && p.x() <= usable_.cols - 1.0 && p.y() <= usable_.rows - 1.0;
  }

 private:
  image::RegionPyramid pyramid_;
  cv::Mat1b usable_;
};

}  // namespace laparoscope_servo::features
