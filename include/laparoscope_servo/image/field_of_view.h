// What of a laparoscope's image shows the abdomen: most endoscopes see a circle, of which the image cuts off parts, and
// leave black what is beyond.
#pragma once

#include <opencv2/core.hpp>
#include <vector>

namespace laparoscope_servo::image {

class FieldOfView {
 public:
  // Takes the convex hull of what is lit: a dark instrument that enters through the border bites into what is lit, but
  // not into its hull. `level`: grey levels of each cell.
  void compute(const cv::Mat1b& level);

  // Cells, false outside of the image.
  bool contains(int x, int y) const {
    return y >= 0 && y < static_cast<int>(rows_.size()) && x >= rows_[static_cast<std::size_t>(y)].start &&
           x < rows_[static_cast<std::size_t>(y)].end;
  }
  // No cell within `margin` of it, along row or column, is outside.
  bool isDeep(int x, int y, int margin) const {
    return contains(x - margin, y) && contains(x + margin, y) && contains(x, y - margin) && contains(x, y + margin);
  }
  int area() const { return area_; }  // cells
  const cv::Range& row(int y) const { return rows_[static_cast<std::size_t>(y)]; }

 private:
  void bound(const std::vector<cv::Point>& points, int sign);

  std::vector<cv::Range> rows_;  // of each row, the columns that belong to it
  std::vector<cv::Point> left_, right_, chain_;
  int area_ = 0;
};

}  // namespace laparoscope_servo::image
