#include "laparoscope_servo/features/edge_profile.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "laparoscope_servo/image/multiversion.h"

namespace laparoscope_servo::features {

namespace {

constexpr int kMargin = EdgeProfile::kReach + 1;  // samples beyond the range, and on either side of the site at least
constexpr int kRound = 8;  // loops that are vectorised run over a multiple of it: what lies beyond does not count

// What the samples of a window are places in: a row along the normal for each place across it.
struct Rows {
  float u, v;                // the first sample of the first row
  float along_u, along_v;    // from sample to sample
  float across_u, across_v;  // from row to row
  int rows, count;           // count: samples of a row
  int padded() const { return (count + kRound - 1) / kRound * kRound; }
};

// The samples lie in the image, but for those that pad a row: the next row is written over them.
LAPAROSCOPE_SERVO_CLONES
void place(const Rows& window, int stride, int channels, std::int32_t* __restrict offset, float* __restrict right_of,
           float* __restrict below) {
  const float du = window.along_u, dv = window.along_v;
  const int padded = window.padded();
  for (int row = 0; row < window.rows; ++row) {
    const float u = window.u + static_cast<float>(row) * window.across_u;
    const float v = window.v + static_cast<float>(row) * window.across_v;
#pragma omp simd
    for (int k = 0; k < padded; ++k) {
      const float x = u + static_cast<float>(k) * du, y = v + static_cast<float>(k) * dv;
      const int i = static_cast<int>(x), j = static_cast<int>(y);
      offset[k] = j * stride + i * channels;
      right_of[k] = x - static_cast<float>(i);
      below[k] = y - static_cast<float>(j);
    }
    offset += window.count;
    right_of += window.count;
    below += window.count;
  }
}

// Adds the rows' bilinear levels, times `share`.
LAPAROSCOPE_SERVO_CLONES
void addBlend(const Rows& window, const std::uint32_t* __restrict neighbours, const float* __restrict right_of,
              const float* __restrict below, float share, float* __restrict sums) {
  const int padded = window.padded();
  for (int row = 0; row < window.rows; ++row) {
#pragma omp simd
    for (int k = 0; k < padded; ++k) {
      const std::int32_t n = static_cast<std::int32_t>(neighbours[k]);
      const float p = static_cast<float>(n & 255), p_right = static_cast<float>((n >> 8) & 255);
      const float q = static_cast<float>((n >> 16) & 255), q_right = static_cast<float>((n >> 24) & 255);
      const float above = p + right_of[k] * (p_right - p), under = q + right_of[k] * (q_right - q);
      sums[k] += share * (above + below[k] * (under - above));
    }
    neighbours += window.count;
    right_of += window.count;
    below += window.count;
  }
}

// Of one channel of an image with so many.
template <int kChannels>
void gather(const unsigned char* data, std::size_t stride, const std::int32_t* __restrict offset, int count,
            std::uint32_t* __restrict neighbours) {
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

bool EdgeProfile::read(const cv::Mat& image, const Site& site, const EdgeWindow& window) {
  const double most = std::min(std::ceil(window.range / window.step) + kMargin, kMost / 2 - 1.0);
  const Eigen::Vector2d along = window.step * site.normal;
  const Eigen::Vector2d across = window.step * Eigen::Vector2d(-site.normal.y(), site.normal.x());
  const Eigen::Vector2d end(image.cols - 1.001, image.rows - 1.001);
  const Eigen::Vector2d reach = most * along.cwiseAbs() + kHalfWidth * across.cwiseAbs();
  double low = -most, high = most;
  // Most windows lie in the image, which takes no division to tell; a NaN does not.
  const bool whole = ((site.point - reach).array() >= 0.0).all() && ((site.point + reach - end).array() <= 0.0).all();
  if (!whole) {
    for (const int t : {-kHalfWidth, kHalfWidth}) {
      const Eigen::Vector2d start = site.point + t * across;
      clip(start.x(), along.x(), 0.0, end.x(), low, high);
      clip(start.y(), along.y(), 0.0, end.y(), low, high);
    }
  }
  // Single precision may put the last sample a little further out.
  const double first = std::ceil(low + 1e-3), last = std::floor(high - 1e-3);
  if (!(first <= -kMargin && last >= kMargin)) return false;  // before the casts: of a site far out they may not fit
  first_ = static_cast<int>(first);
  count_ = static_cast<int>(last) - first_ + 1;
  constexpr float kLuma[] = {0.114f, 0.587f, 0.299f};  // of blue, green and red
  const Eigen::Vector2f start = (site.point - kHalfWidth * across + first_ * along).cast<float>();
  const Eigen::Vector2f next_row = (window.across_stride * across).cast<float>(), next = along.cast<float>();
  const Rows rows = {
      start.x(), start.y(), next.x(), next.y(), next_row.x(), next_row.y(), 2 * kHalfWidth / window.across_stride + 1,
      count_};
  const float share = 1.0f / static_cast<float>(rows.rows);
  const int stride = static_cast<int>(image.step), samples = rows.rows * count_;
  std::fill_n(levels_.begin(), rows.padded(), 0.0f);
  place(rows, stride, image.channels(), offset_.data(), right_of_.data(), below_.data());
  if (image.channels() == 1) {
    gather<1>(image.data, image.step, offset_.data(), samples, neighbours_.data());
    addBlend(rows, neighbours_.data(), right_of_.data(), below_.data(), share, levels_.data());
    return true;
  }
  for (int channel = 0; channel < 3; ++channel) {
    gather<3>(image.data + channel, image.step, offset_.data(), samples, neighbours_.data());
    addBlend(rows, neighbours_.data(), right_of_.data(), below_.data(), share * kLuma[channel], levels_.data());
  }
  return true;
}

}  // namespace laparoscope_servo::features
