// An image as the tracker of points takes it, by its default parameters.
#pragma once

#include "features/points/point_image.h"
#include "laparoscope_servo/features/points.h"

namespace laparoscope_servo::features {

inline PointImage seen(const cv::Mat& image) {
  const PointsConfig config;
  PointImage result;
  result.take(image, config.levels, config.saturation);
  return result;
}

}  // namespace laparoscope_servo::features
