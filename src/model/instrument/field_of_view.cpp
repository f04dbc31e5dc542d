#include "model/instrument/field_of_view.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace laparoscope_servo::model {

namespace {

constexpr int kDark = 14;  // grey levels: black is at 0 to 16 in video, with noise on it
constexpr int kRun = 4;    // cells side by side that are lit, to tell the picture from single bright pixels beyond it

}  // namespace

void FieldOfView::compute(const cv::Mat1b& level) {
  rows_.assign(static_cast<std::size_t>(level.rows), cv::Range(0, 0));
  points_.clear();
  for (int y = 0; y < level.rows; ++y) {
    const uchar* row = level[y];
    int first = -1, last = -1, run = 0;
    for (int x = 0; x < level.cols; ++x) {
      run = row[x] > kDark ? run + 1 : 0;
      if (run < kRun) continue;
      if (first < 0) first = x - kRun + 1;
      last = x;
    }
    if (first < 0) continue;
    points_.emplace_back(first, y);
    points_.emplace_back(last, y);
  }
  area_ = 0;
  if (points_.size() < 6) return;
  cv::convexHull(points_, hull_);

  // The hull's edges, row by row.
  const std::size_t count = hull_.size();
  std::vector<cv::Range>& rows = rows_;
  for (auto& r : rows) r = cv::Range(level.cols, 0);
  for (std::size_t i = 0; i < count; ++i) {
    cv::Point a = hull_[i], b = hull_[(i + 1) % count];
    if (a.y > b.y) std::swap(a, b);
    for (int y = a.y; y <= b.y; ++y) {
      const double x = a.y == b.y ? a.x : a.x + static_cast<double>(b.x - a.x) * (y - a.y) / (b.y - a.y);
      cv::Range& r = rows[static_cast<std::size_t>(y)];
      r.start = std::min(r.start, static_cast<int>(std::floor(x)));
      r.end = std::max(r.end, static_cast<int>(std::ceil(x)) + 1);
      if (a.y == b.y) r.end = std::max(r.end, b.x + 1), r.start = std::min(r.start, b.x);
    }
  }
  for (auto& r : rows) {
    if (r.end <= r.start) r = cv::Range(0, 0);
    area_ += r.size();
  }
}

}  // namespace laparoscope_servo::model
