#include "motion/square_weights.h"

#include <algorithm>

namespace laparoscope_servo::motion {

namespace {

// 1 where all of `count` x `count` squares from (j, i) on can be used, 0 where half of them or fewer can.
float weightOf(const Squares& squares, int j, int i, int count) {
  const cv::Rect box = cv::Rect(i, j, count, count) & cv::Rect(0, 0, squares.cols, squares.rows);
  int usable = 0;
  for (int v = box.y; v < box.y + box.height; ++v) {
    for (int u = box.x; u < box.x + box.width; ++u) usable += squares(v, u);
  }
  return std::max(0.0f, 2.0f * static_cast<float>(usable) / static_cast<float>(std::max(1, box.area())) - 1.0f);
}

}  // namespace

void setWeights(const Squares& squares, int side, tracking::EsmLevel& level) {
  const int scale = static_cast<int>(level.scale);
  const int pixels = std::max(1, side / scale);    // of the level, along a square
  const int together = std::max(1, scale / side);  // squares along a pixel
  for (int j = 0; j < level.height; ++j) {
    float* row = level.weight.row(j);
    if (j % pixels != 0) {
      std::copy_n(level.weight.row(j - 1), level.width, row);
      continue;
    }
    for (int i = 0; i < level.width; i += pixels) {
      const float weight = weightOf(squares, j / pixels * together, i / pixels * together, together);
      std::fill(row + i, row + std::min(i + pixels, level.width), weight);
    }
  }
}

}  // namespace laparoscope_servo::motion
