#include "laparoscope_servo/image/pyramid.h"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "laparoscope_servo/image/image_type.h"
#include "laparoscope_servo/image/multiversion.h"

namespace laparoscope_servo::image {

namespace {

// The first smoothing: a kernel of three pixels with the variance of a Gaussian of sigma 0.65 px.
constexpr double kSmoothSide = 0.5 * 0.65 * 0.65;
constexpr double kSmoothMiddle = 1.0 - 2.0 * kSmoothSide;
constexpr float kSide = 0.5f * 0.65f * 0.65f;
constexpr float kMiddle = 1.0f - 2.0f * kSide;

constexpr int kPadding = 2;  // pixels on each side of a row that is halved

LAPAROSCOPE_SERVO_CLONES
void weighRow(const unsigned char* __restrict from, int count, float b, float g, float r, float* __restrict to) {
#pragma omp simd
  for (int u = 0; u < count; ++u) to[u] = b * from[3 * u] + g * from[3 * u + 1] + r * from[3 * u + 2];
}

LAPAROSCOPE_SERVO_CLONES
void convertRow(const unsigned char* __restrict from, int count, float* __restrict to) {
#pragma omp simd
  for (int u = 0; u < count; ++u) to[u] = from[u];
}

// `row` has a pixel beyond each of its ends.
LAPAROSCOPE_SERVO_CLONES
void smoothAlong(const float* __restrict row, int count, float* __restrict to) {
#pragma omp simd
  for (int u = 0; u < count; ++u) to[u] = kMiddle * row[u] + kSide * (row[u - 1] + row[u + 1]);
}

LAPAROSCOPE_SERVO_CLONES
void smoothAcross(const float* __restrict above, const float* __restrict row, const float* __restrict below, int count,
                  float* __restrict to) {
#pragma omp simd
  for (int u = 0; u < count; ++u) to[u] = kMiddle * row[u] + kSide * (above[u] + below[u]);
}

// Binomial weights 1 4 6 4 1, across the rows and then along them.
LAPAROSCOPE_SERVO_CLONES
void halveAcross(const float* __restrict a, const float* __restrict b, const float* __restrict c,
                 const float* __restrict d, const float* __restrict e, int count, float* __restrict to) {
#pragma omp simd
  for (int u = 0; u < count; ++u) to[u] = (a[u] + e[u] + 4.0f * (b[u] + d[u]) + 6.0f * c[u]) * (1.0f / 256.0f);
}

// `row` has two pixels beyond each of its ends.
LAPAROSCOPE_SERVO_CLONES
void halveAlong(const float* __restrict row, int count, float* __restrict to) {
#pragma omp simd
  for (int i = 0; i < count; ++i) {
    const float* r = row + 2 * i;
    to[i] = r[-2] + r[2] + 4.0f * (r[-1] + r[1]) + 6.0f * r[0];
  }
}

// The row used for row k beyond the first or the last: mirrored there.
int mirrored(int k, int size) {
  if (k < 0) k = -k;
  if (k >= size) k = 2 * size - 2 - k;
  return std::clamp(k, 0, size - 1);
}

cv::Size halved(const cv::Size& size) {
  return {(size.width + 1) / 2, (size.height + 1) / 2};
}

}  // namespace

// Both kernels are separable, so the kernel along a row tells all. Halving puts its 1 4 6 4 1 onto every scale-th
// pixel.
LevelNoise levelNoise(int scale) {
  std::vector<double> kernel = {kSmoothSide, kSmoothMiddle, kSmoothSide};
  for (int step = 1; step < scale; step *= 2) {
    std::vector<double> wider(kernel.size() + 4 * step, 0.0);
    const double binomial[] = {1.0 / 16.0, 4.0 / 16.0, 6.0 / 16.0, 4.0 / 16.0, 1.0 / 16.0};
    for (int tap = 0; tap < 5; ++tap) {
      for (std::size_t k = 0; k < kernel.size(); ++k) wider[k + tap * step] += binomial[tap] * kernel[k];
    }
    kernel = wider;
  }
  // of pixels of the level `apart` from each other
  const auto covariance = [&](std::size_t apart) {
    double sum = 0.0;
    for (std::size_t k = apart * scale; k < kernel.size(); ++k) sum += kernel[k] * kernel[k - apart * scale];
    return sum;
  };
  return {covariance(0), (covariance(0) - covariance(2)) * covariance(0)};
}

void RegionPyramid::Plane::resize(const cv::Size& size, const cv::Size& most) {
  if (view.size() == size) return;
  data.reserve(most.area());
  data.resize(std::max(data.size(), static_cast<std::size_t>(size.area())));
  view = cv::Mat1f(size.height, size.width, data.data());
}

// Rows are converted and smoothed along, three at a time, and then across. They are extrapolated linearly beyond the
// region, so that its border is not smoothed in that direction.
void RegionPyramid::smooth(const cv::Mat& image, const ChannelWeights& weights, cv::Mat1f& level) {
  const int width = level.cols;
  const int height = level.rows;
  const std::size_t stride = static_cast<std::size_t>(width) + 2;
  rows_.resize(std::max(rows_.size(), 4 * stride));
  float* const raw = rows_.data() + 1;
  const auto smoothed = [&](int v) { return rows_.data() + stride * (1 + v % 3); };
  for (int v = 0; v <= height; ++v) {
    if (v < height) {
      if (image.channels() == 1) {
        convertRow(image.ptr<unsigned char>(v), width, raw);
      } else {
        weighRow(image.ptr<unsigned char>(v), width, weights[0], weights[1], weights[2], raw);
      }
      raw[-1] = width > 1 ? 2.0f * raw[0] - raw[1] : raw[0];
      raw[width] = width > 1 ? 2.0f * raw[width - 1] - raw[width - 2] : raw[0];
      smoothAlong(raw, width, smoothed(v));
    }
    if (v == 0) continue;
    float* to = level.ptr<float>(v - 1);
    if (v == 1 || v == height) {
      std::copy_n(smoothed(v - 1), width, to);
    } else {
      smoothAcross(smoothed(v - 2), smoothed(v - 1), smoothed(v), width, to);
    }
  }
}

void RegionPyramid::halve(const cv::Mat1f& fine, cv::Mat1f& coarse) {
  const int width = fine.cols;
  rows_.resize(std::max(rows_.size(), static_cast<std::size_t>(width) + 2 * kPadding));
  float* const row = rows_.data() + kPadding;
  for (int j = 0; j < coarse.rows; ++j) {
    const auto near = [&](int k) { return fine.ptr<float>(mirrored(2 * j + k, fine.rows)); };
    halveAcross(near(-2), near(-1), near(0), near(1), near(2), width, row);
    for (int k = 1; k <= kPadding; ++k) {
      row[-k] = row[mirrored(-k, width)];
      row[width - 1 + k] = row[mirrored(width - 1 + k, width)];
    }
    halveAlong(row, coarse.cols, coarse.ptr<float>(j));
  }
}

void RegionPyramid::build(const cv::Mat& image, const cv::Rect& region, int levels, const Channels& channels,
                          int finest) {
  checkType(image);
  const cv::Rect inside = region & cv::Rect(0, 0, image.cols, image.rows);
  if (inside.empty() || levels < 1) {
    throw std::invalid_argument("region of interest holds no pixel of the image");
  }
  region_ = inside;
  skipped_ = 0;
  while (1 << skipped_ < finest) ++skipped_;
  levels_ = levels;
  const int all = skipped_ + levels_;
  channels_ = image.channels() == 1 ? 1 : channels.count;
  const std::size_t count = static_cast<std::size_t>(channels_) * all;
  if (planes_.size() != count) planes_ = std::vector<Plane>(count);  // a plane's view would not survive a copy
  rows_.reserve(4 * (static_cast<std::size_t>(image.cols) + 2 * kPadding));
  for (int c = 0; c < channels_; ++c) {
    Plane* plane = planes_.data() + static_cast<std::size_t>(c) * all;
    cv::Size most = image.size();
    plane[0].resize(region_.size(), most);
    smooth(image(region_), channels.weights[c], plane[0].view);
    for (int l = 1; l < all; ++l) {
      most = halved(most);
      plane[l].resize(halved(plane[l - 1].view.size()), most);
      halve(plane[l - 1].view, plane[l].view);
    }
  }
}

}  // namespace laparoscope_servo::image
