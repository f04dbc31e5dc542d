#include "features/shafts/mask_drawing.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "laparoscope_servo/image/multiversion.h"

namespace laparoscope_servo::features {

namespace {

constexpr int kFurthest = 255;  // px, of a pixel from the nearest one of its row

// Distances along a row of `count` pixels.
void rowDistances(const std::uint8_t* set, int count, std::uint8_t* distances) {
  int distance = kFurthest;
  for (int x = 0; x < count; ++x) {
    distance = set[x] != 0 ? 0 : std::min(distance + 1, kFurthest);
    distances[x] = static_cast<std::uint8_t>(distance);
  }
  distance = kFurthest;
  for (int x = count - 1; x >= 0; --x) {
    distance = set[x] != 0 ? 0 : std::min(distance + 1, kFurthest);
    distances[x] = static_cast<std::uint8_t>(std::min<int>(distances[x], distance));
  }
}

// Sets in `to` each of `count` pixels whose distance is at most `half`.
LAPAROSCOPE_SERVO_CLONES
void setNear(const std::uint8_t* __restrict distances, int count, int half, std::uint8_t* __restrict to) {
  const auto limit = static_cast<std::uint8_t>(half);
#pragma omp simd
  for (int x = 0; x < count; ++x) {
    to[x] = static_cast<std::uint8_t>(to[x] | (distances[x] <= limit ? 255 : 0));
  }
}

// Half the width of a disc's row, px.
int halfWidth(int radius, int row) {
  return static_cast<int>(std::lround(std::sqrt(static_cast<double>(radius * radius - row * row))));
}

}  // namespace

cv::Rect drawQuadrangle(const std::array<Eigen::Vector2d, 4>& corners, cv::Mat1b& mask) {
  double top = std::numeric_limits<double>::infinity(), bottom = -top;
  for (const Eigen::Vector2d& p : corners) {
    if (!p.allFinite()) return {};
    top = std::min(top, p.y());
    bottom = std::max(bottom, p.y());
  }
  const int first = static_cast<int>(std::lround(std::clamp(top, 0.0, static_cast<double>(mask.rows))));
  const int last = static_cast<int>(std::lround(std::clamp(bottom, -1.0, mask.rows - 1.0)));
  cv::Rect drawn;
  for (int y = first; y <= last; ++y) {
    // A row that the quadrangle's corner lies in, but not its middle, is as wide as at the corner.
    const double at = std::clamp(static_cast<double>(y), top, bottom);
    double left = std::numeric_limits<double>::infinity(), right = -left;
    for (std::size_t k = 0; k < 4; ++k) {
      const Eigen::Vector2d &a = corners[k], &b = corners[(k + 1) % 4];
      if (at < std::min(a.y(), b.y()) || at > std::max(a.y(), b.y())) continue;
      const double share = a.y() == b.y() ? 0.0 : (at - a.y()) / (b.y() - a.y());
      const double x = a.x() + share * (b.x() - a.x());
      left = std::min(left, a.y() == b.y() ? std::min(a.x(), b.x()) : x);
      right = std::max(right, a.y() == b.y() ? std::max(a.x(), b.x()) : x);
    }
    const int begin = static_cast<int>(std::lround(std::clamp(left, 0.0, static_cast<double>(mask.cols))));
    const int end = static_cast<int>(std::lround(std::clamp(right, -1.0, mask.cols - 1.0))) + 1;
    if (begin >= end) continue;
    std::fill(mask[y] + begin, mask[y] + end, std::uint8_t{255});
    drawn |= cv::Rect(begin, y, end - begin, 1);
  }
  return drawn;
}

void MaskGrowth::add(const cv::Mat1b& source, const cv::Rect& box, int radius, cv::Mat1b& target) {
  if (box.empty()) return;
  if (distances_.size() < source.total()) distances_.resize(source.total());
  const cv::Rect grown =
      (box + cv::Size(2 * radius, 2 * radius) - cv::Point(radius, radius)) & cv::Rect(cv::Point(0, 0), source.size());
  for (int y = box.y; y < box.y + box.height; ++y) {
    rowDistances(source[y] + grown.x, grown.width,
                 &distances_[static_cast<std::size_t>(y - box.y) * static_cast<std::size_t>(grown.width)]);
  }
  for (int row = -radius; row <= radius; ++row) {
    const int half = halfWidth(radius, row);
    const int first = std::max(grown.y, box.y - row), last = std::min(grown.y + grown.height, box.y + box.height - row);
    for (int y = first; y < last; ++y) {
      const std::size_t row_begin = static_cast<std::size_t>(y + row - box.y) * static_cast<std::size_t>(grown.width);
      setNear(&distances_[row_begin], grown.width, half, target[y] + grown.x);
    }
  }
}

}  // namespace laparoscope_servo::features
