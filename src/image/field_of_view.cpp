#include "laparoscope_servo/image/field_of_view.h"

#include <cmath>

namespace laparoscope_servo::image {

namespace {

constexpr int kDark = 14;  // grey levels: black is at 0 to 16 in video, with noise on it
constexpr int kRun = 4;    // cells side by side that are lit, to tell the picture from single bright pixels beyond it
constexpr std::size_t kRows = 3;  // with something lit, at least

}  // namespace

// The hull's border on one side, row by row: `sign` * column is least on it. Points come by rows, top first.
void FieldOfView::bound(const std::vector<cv::Point>& points, int sign) {
  chain_.clear();
  for (const cv::Point& p : points) {
    while (chain_.size() >= 2 && sign * (p - chain_.back()).cross(chain_.back() - chain_[chain_.size() - 2]) <= 0)
      chain_.pop_back();
    chain_.push_back(p);
  }
  for (std::size_t i = 0; i + 1 < chain_.size(); ++i) {
    const cv::Point a = chain_[i], b = chain_[i + 1];
    for (int y = a.y; y <= b.y; ++y) {
      const double x = a.x + static_cast<double>(b.x - a.x) * (y - a.y) / (b.y - a.y);
      cv::Range& row = rows_[static_cast<std::size_t>(y)];
      if (sign > 0) {
        row.start = static_cast<int>(std::floor(x));
      } else {
        row.end = static_cast<int>(std::ceil(x)) + 1;
      }
    }
  }
}

void FieldOfView::compute(const cv::Mat1b& level) {
  rows_.assign(static_cast<std::size_t>(level.rows), cv::Range(0, 0));
  for (std::vector<cv::Point>* points : {&left_, &right_, &chain_}) {
    points->clear();
    points->reserve(static_cast<std::size_t>(level.rows));
  }
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
    left_.emplace_back(first, y);
    right_.emplace_back(last, y);
  }
  area_ = 0;
  if (left_.size() < kRows) return;
  bound(left_, 1);
  bound(right_, -1);
  for (const cv::Range& row : rows_) area_ += row.size();
}

}  // namespace laparoscope_servo::image
