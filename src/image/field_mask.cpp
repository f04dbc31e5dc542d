#include "laparoscope_servo/image/field_mask.h"

#include <algorithm>
#include <cstring>

namespace laparoscope_servo::image {

namespace {

constexpr int kCells = 160;  // across the image: a cell is wider than the border is blurred, and 0.05 ms find the hull
constexpr int kMargin = 1;   // cells within the border that count as beyond: there it is blurred, or lies between cells

int levelOf(const cv::Mat& image, int x, int y) {
  if (image.channels() == 1) return image.ptr<uchar>(y)[x];
  const cv::Vec3b& pixel = image.ptr<cv::Vec3b>(y)[x];
  return (pixel[0] + pixel[1] + pixel[2]) / 3;
}

}  // namespace

void FieldMask::look(const cv::Mat& image) {
  size_ = image.size();
  step_ = std::max(1, image.cols / kCells);
  cells_.create(std::max(1, image.rows / step_), std::max(1, image.cols / step_));
  for (int j = 0; j < cells_.rows; ++j) {
    for (int i = 0; i < cells_.cols; ++i)
      cells_(j, i) = static_cast<uchar>(levelOf(image, i * step_ + step_ / 2, j * step_ + step_ / 2));
  }
  view_.compute(cells_);
  whole_ = view_.area() == 0 || view_.area() == static_cast<int>(cells_.total());
}

bool FieldMask::contains(const cv::Rect& box) const {
  if (whole_) return true;
  // The field of view is convex, and so is what is deep in it.
  const auto deep = [&](int x, int y) { return view_.isDeep(x / step_, y / step_, kMargin + 1); };
  const int right = box.x + box.width - 1, bottom = box.y + box.height - 1;
  return deep(box.x, box.y) && deep(right, box.y) && deep(box.x, bottom) && deep(right, bottom);
}

// Columns [px] of this row of the image that are not beyond. The margin is left out where the image itself ends.
cv::Range FieldMask::within(int y) const {
  cv::Range cells(0, cells_.cols);
  const int row = std::min(y / step_, cells_.rows - 1);
  for (int j = std::max(row - kMargin, 0); j <= std::min(row + kMargin, cells_.rows - 1); ++j)
    cells = cells & view_.row(j);
  if (cells.empty()) return {0, 0};
  const int first = cells.start == 0 ? 0 : (cells.start + kMargin) * step_;
  const int last = cells.end == cells_.cols ? size_.width : (cells.end - kMargin) * step_;
  return {std::min(first, last), last};
}

double FieldMask::shareBeyond(const cv::Rect& box) const {
  const cv::Rect seen = box & cv::Rect(cv::Point(0, 0), size_);
  if (whole_ || seen.empty()) return 0.0;
  double inside = 0.0;
  for (int y = seen.y; y < seen.y + seen.height; ++y)
    inside += (within(y) & cv::Range(seen.x, seen.x + seen.width)).size();
  return 1.0 - inside / seen.area();
}

const cv::Mat& FieldMask::joined(const cv::Mat& mask) {
  if (whole_) return mask;
  joined_.create(size_, CV_8UC1);
  for (int y = 0; y < size_.height; ++y) {
    uchar* const row = joined_.ptr<uchar>(y);
    const cv::Range inside = within(y);
    std::memset(row, 255, static_cast<std::size_t>(inside.start));
    if (mask.empty()) {
      std::memset(row + inside.start, 0, static_cast<std::size_t>(inside.size()));
    } else {
      const uchar* const covered = mask.ptr<uchar>(y);
      for (int x = inside.start; x < inside.end; ++x) row[x] = covered[x] != 0 ? 255 : 0;
    }
    std::memset(row + inside.end, 255, static_cast<std::size_t>(size_.width - inside.end));
  }
  return joined_;
}

}  // namespace laparoscope_servo::image
