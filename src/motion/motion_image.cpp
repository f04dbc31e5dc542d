#include "motion/motion_image.h"

#include <algorithm>

namespace laparoscope_servo::motion {

namespace {

constexpr int kLeastSide = 48;  // px of the coarsest level: enough for a quadratic motion

int levelsFor(const cv::Size& finest) {
  int levels = 1;
  for (int side = std::min(finest.width, finest.height) / 2; side >= kLeastSide && levels < MotionImage::kMostLevels;
       side /= 2) {
    ++levels;
  }
  return levels;
}

}  // namespace

int finestScale(const cv::Size& size, int max_pixels) {
  int scale = 1;
  while (static_cast<double>(size.width) * size.height / (scale * scale) > max_pixels) scale *= 2;
  return scale;
}

void MotionImage::take(const cv::Mat& image, const cv::Mat& mask, const MotionConfig& config) {
  const int finest = finestScale(image.size(), config.max_pixels);
  const int levels = levelsFor(image.size() / finest);
  pyramid.build(image, cv::Rect(0, 0, image.cols, image.rows), levels, image::kLuma, finest);
  usable.look(image, mask, config.saturation, config.darkness);
}

}  // namespace laparoscope_servo::motion
