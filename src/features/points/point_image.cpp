#include "features/points/point_image.h"

#include <algorithm>

namespace laparoscope_servo::features {

namespace {

constexpr int kGrow = 2;        // px around a saturated pixel, to which it is smoothed and its highlight glows
constexpr int kLeastSide = 24;  // px of the coarsest level

}  // namespace

void PointImage::take(const cv::Mat& image, int levels, int saturation) {
  int possible = 1;
  while (possible < levels && std::min(image.cols, image.rows) >> possible >= kLeastSide) ++possible;
  pyramid_.build(image, cv::Rect(cv::Point(0, 0), image.size()), possible, image::kLuma);
  usable_.create(image.size());
  for (int v = 0; v < image.rows; ++v)
    std::fill_n(usable_.ptr<unsigned char>(v), image.cols, static_cast<unsigned char>(1));
  const int channels = image.channels(), count = image.cols * channels;
  for (int v = 0; v < image.rows; ++v) {
    const unsigned char* row = image.ptr<unsigned char>(v);
    int brightest = 0;
    for (int k = 0; k < count; ++k) brightest = std::max<int>(brightest, row[k]);
    if (brightest < saturation) continue;
    for (int k = 0; k < count; ++k) {
      if (row[k] < saturation) continue;
      const int u = k / channels;
      for (int j = std::max(0, v - kGrow); j <= std::min(image.rows - 1, v + kGrow); ++j) {
        unsigned char* to = usable_.ptr<unsigned char>(j);
        std::fill(to + std::max(0, u - kGrow), to + std::min(image.cols, u + kGrow + 1), static_cast<unsigned char>(0));
      }
    }
  }
}

}  // namespace laparoscope_servo::features
