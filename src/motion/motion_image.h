// An image of which the motion is estimated.
#pragma once

#include <opencv2/core.hpp>

#include "laparoscope_servo/image/pyramid.h"
#include "laparoscope_servo/motion/motion_config.h"
#include "motion/usable_pixels.h"

namespace laparoscope_servo::motion {

// What the estimator needs of an image.
struct MotionImage {
  static constexpr int kMostLevels = 8;

  image::RegionPyramid pyramid;  // of the whole image
  UsablePixels usable;

  // Throws std::invalid_argument for an image of a type that it cannot use. Does not allocate for a further image of
  // the same size and type.
  void take(const cv::Mat& image, const cv::Mat& mask, const MotionConfig& config);
};

// px of the image per pixel of the finest level that is used.
int finestScale(const cv::Size& size, int max_pixels);

}  // namespace laparoscope_servo::motion
