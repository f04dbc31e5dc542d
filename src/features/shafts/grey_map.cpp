#include "features/shafts/grey_map.h"

#include <algorithm>
#include <cmath>

namespace laparoscope_servo::features {

namespace {

// Grey levels by which colour may be off where it is dark, since chroma is quantised; and the level below which there
// is no telling. Such cells are taken for coloured rather than for grey.
constexpr float kDoubt = 0.5f;
constexpr float kBlack = 12.0f;
constexpr double kFar = 1e6;  // cells: points further out are in no map, and may not fit an int

}  // namespace

cv::Point GreyMap::cellOf(const Eigen::Vector2d& p) {
  if (!(p.array().abs() < kFar).all()) return {-1, -1};  // also NaN
  return {static_cast<int>(std::lround(p.x())), static_cast<int>(std::lround(p.y()))};
}

void GreyMap::compute(const cv::Mat& image) {
  step_ = std::max(1, (image.cols + kColumns / 2) / kColumns);
  const int columns = image.cols / step_, rows = image.rows / step_;
  colour_.create(rows, columns);
  level_.create(rows, columns);
  const std::size_t bytes = static_cast<std::size_t>(columns) * step_ * 3;
  sums_.resize(bytes);
  for (auto* channel : {&blue_, &green_, &red_}) channel->resize(static_cast<std::size_t>(columns));

  const float part = 1.0f / static_cast<float>(step_ * step_);
  for (int y = 0; y < rows; ++y) {
    std::fill(sums_.begin(), sums_.end(), std::uint16_t{0});
    for (int k = 0; k < step_; ++k) {
      const uchar* row = image.ptr<uchar>(y * step_ + k);
      for (std::size_t i = 0; i < bytes; ++i) sums_[i] = static_cast<std::uint16_t>(sums_[i] + row[i]);
    }
    const std::uint16_t* p = sums_.data();
    for (int x = 0; x < columns; ++x) {
      unsigned b = 0, g = 0, r = 0;
      for (int k = 0; k < step_; ++k, p += 3) {
        b += p[0];
        g += p[1];
        r += p[2];
      }
      blue_[static_cast<std::size_t>(x)] = part * static_cast<float>(b);
      green_[static_cast<std::size_t>(x)] = part * static_cast<float>(g);
      red_[static_cast<std::size_t>(x)] = part * static_cast<float>(r);
    }
    uchar *colour = colour_[y], *level = level_[y];
    for (int x = 0; x < columns; ++x) {
      const std::size_t i = static_cast<std::size_t>(x);
      const float b = blue_[i], g = green_[i], r = red_[i];
      const float s0 = std::max(std::max(b, g), r) - std::min(std::min(b, g), r);
      const float d = (r - g) * (r - g) + (r - b) * (g - b);
      const float feature = 0.5f * (2.0f * r - g - b) * s0 / std::sqrt(std::max(d, 1e-3f));  // eq. (4), (5)
      const float mean = (b + g + r) * (1.0f / 3.0f);
      const float value = static_cast<float>(kZero) + static_cast<float>(kUnit) * (feature + kDoubt) / (mean + 1.0f);
      colour[x] = mean < kBlack ? uchar{255} : static_cast<uchar>(std::min(std::max(value, 0.0f), 255.0f));
      level[x] = static_cast<uchar>(mean);
    }
  }
}

}  // namespace laparoscope_servo::features
