#include "laparoscope_servo/features/edge_profile.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "laparoscope_servo/image/multiversion.h"

namespace laparoscope_servo::features {

namespace {

constexpr int kMargin = EdgeProfile::kReach + 1;  // samples beyond the range, and on either side of the site at least
constexpr int kRound = 8;  // loops that are vectorised run over a multiple of it: what lies beyond does not count

// (u, v) + k (du, dv); the samples that count lie in the image.
LAPAROSCOPE_SERVO_CLONES
void place(float u, float v, float du, float dv, int stride, int channels, int count, std::int32_t* __restrict offset,
           float* __restrict right_of, float* __restrict below) {
#pragma omp simd
  for (int k = 0; k < count; ++k) {
    const float x = u + static_cast<float>(k) * du, y = v + static_cast<float>(k) * dv;
    const int i = static_cast<int>(x), j = static_cast<int>(y);
    offset[k] = j * stride + i * channels;
    right_of[k] = x - static_cast<float>(i);
    below[k] = y - static_cast<float>(j);
  }
}

LAPAROSCOPE_SERVO_CLONES
void addBlend(const std::uint32_t* __restrict neighbours, const float* __restrict right_of,
              const float* __restrict below, float share, int count, float* __restrict sums) {
#pragma omp simd
  for (int k = 0; k < count; ++k) {
    const std::int32_t n = static_cast<std::int32_t>(neighbours[k]);
    const float p = static_cast<float>(n & 255), p_right = static_cast<float>((n >> 8) & 255);
    const float q = static_cast<float>((n >> 16) & 255), q_right = static_cast<float>((n >> 24) & 255);
    const float above = p + right_of[k] * (p_right - p), under = q + right_of[k] * (q_right - q);
    sums[k] += share * (above + below[k] * (under - above));
  }
}

// Of one channel of an image with so many.
template <int kChannels>
void gather(const unsigned char* data, std::size_t stride, const std::int32_t* offset, int count,
            std::uint32_t* neighbours) {
  for (int k = 0; k < count; ++k) {
    const unsigned char *p = data + offset[k], *q = p + stride;
    const std::uint16_t upper = static_cast<std::uint16_t>(p[0] | p[kChannels] << 8);
    const std::uint16_t lower = static_cast<std::uint16_t>(q[0] | q[kChannels] << 8);
    neighbours[k] = upper | static_cast<std::uint32_t>(lower) << 16;
  }
}

// The k in [low, high] for which low_end <= start + k slope <= high_end.
void clip(double start, double slope, double low_end, double high_end, double& low, double& high) {
  if (!std::isfinite(start) || !(std::abs(slope) >= 1e-9)) {
    if (!(start >= low_end && start <= high_end) || std::isnan(slope)) high = low - 1.0;
    return;
  }
  const double a = (low_end - start) / slope, b = (high_end - start) / slope;
  low = std::max(low, std::min(a, b));
  high = std::min(high, std::max(a, b));
}

}  // namespace

void EdgeProfile::addRow(const cv::Mat& image, const Eigen::Vector2f& start, const Eigen::Vector2f& along,
                         float share) {
  constexpr float kLuma[] = {0.114f, 0.587f, 0.299f};  // of blue, green and red
  const int padded = (count_ + kRound - 1) / kRound * kRound;
  place(start.x(), start.y(), along.x(), along.y(), static_cast<int>(image.step), image.channels(), padded,
        offset_.data(), right_of_.data(), below_.data());
  if (image.channels() == 1) {
    gather<1>(image.data, image.step, offset_.data(), count_, neighbours_.data());
    addBlend(neighbours_.data(), right_of_.data(), below_.data(), share, padded, levels_.data());
    return;
  }
  for (int channel = 0; channel < 3; ++channel) {
    gather<3>(image.data + channel, image.step, offset_.data(), count_, neighbours_.data());
    addBlend(neighbours_.data(), right_of_.data(), below_.data(), share * kLuma[channel], padded, levels_.data());
  }
}

bool EdgeProfile::read(const cv::Mat& image, const Site& site, const EdgeWindow& window) {
  const double most = std::min(std::ceil(window.range / window.step) + kMargin, kMost / 2 - 1.0);
  const Eigen::Vector2d along = window.step * site.normal;
  const Eigen::Vector2d across = window.step * Eigen::Vector2d(-site.normal.y(), site.normal.x());
  double low = -most, high = most;
  for (const int t : {-kHalfWidth, kHalfWidth}) {
    const Eigen::Vector2d start = site.point + t * across;
    clip(start.x(), along.x(), 0.0, image.cols - 1.001, low, high);
    clip(start.y(), along.y(), 0.0, image.rows - 1.001, low, high);
  }
  // Single precision may put the last sample a little further out.
  const double first = std::ceil(low + 1e-3), last = std::floor(high - 1e-3);
  if (!(first <= -kMargin && last >= kMargin)) return false;  // before the casts: of a site far out they may not fit
  first_ = static_cast<int>(first);
  count_ = static_cast<int>(last) - first_ + 1;
  std::fill_n(levels_.begin(), (count_ + kRound - 1) / kRound * kRound, 0.0f);
  const float share = 1.0f / static_cast<float>(2 * kHalfWidth / window.across_stride + 1);
  for (int t = -kHalfWidth; t <= kHalfWidth; t += window.across_stride) {
    const Eigen::Vector2d start = site.point + t * across + first_ * along;
    addRow(image, start.cast<float>(), along.cast<float>(), share);
  }
  return true;
}

}  // namespace laparoscope_servo::features
