// Splits a region of interest (ROI) into a grid of rectangular areas, row by row (Bourger et al. 2007, section II: 14 x
// 14).
#pragma once

#include <vector>

namespace laparoscope_servo::image {

// Areas differ by at most one pixel in width and in height, and together cover every pixel exactly once.
class AreaGrid {
 public:
  AreaGrid() = default;
  // width, height: px, of the ROI. Throws std::invalid_argument unless 1 <= rows <= height and 1 <= columns <= width.
  AreaGrid(int width, int height, int rows, int columns);

  int rows() const { return rows_; }
  int columns() const { return columns_; }
  int count() const { return rows_ * columns_; }
  int width() const { return width_; }
  int height() const { return height_; }

  // The area that holds the pixel (i, j) of the ROI, i to the right, j down.
  int areaOf(int i, int j) const { return row_of_[j] * columns_ + column_of_[i]; }
  int rowOf(int j) const { return row_of_[j]; }
  int columnOf(int i) const { return column_of_[i]; }
  // First pixel of a column of areas, and of a row; columnBegin(columns()) is width().
  int columnBegin(int column) const { return column_begin_[column]; }
  int rowBegin(int row) const { return row_begin_[row]; }
  int pixelsIn(int area) const;

 private:
  int width_ = 0;
  int height_ = 0;
  int rows_ = 0;
  int columns_ = 0;
  std::vector<int> row_of_;        // per row of pixels
  std::vector<int> column_of_;     // per column of pixels
  std::vector<int> row_begin_;     // rows + 1
  std::vector<int> column_begin_;  // columns + 1
};

}  // namespace laparoscope_servo::image
