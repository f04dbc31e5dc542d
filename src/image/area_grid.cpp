#include "laparoscope_servo/image/area_grid.h"

#include <stdexcept>
#include <string>

namespace laparoscope_servo::image {

namespace {

// Pixel k of `size` lies in part k * parts / size.
void split(int size, int parts, std::vector<int>& part_of, std::vector<int>& begin) {
  part_of.resize(size);
  begin.assign(parts + 1, size);
  for (int k = size - 1; k >= 0; --k) {
    part_of[k] = k * parts / size;
    begin[part_of[k]] = k;
  }
}

}  // namespace

AreaGrid::AreaGrid(int width, int height, int rows, int columns)
    : width_(width), height_(height), rows_(rows), columns_(columns) {
  if (rows < 1 || columns < 1 || rows > height || columns > width) {
    throw std::invalid_argument("grid of " + std::to_string(rows) + " x " + std::to_string(columns) +
                                " areas does not fit a ROI of " + std::to_string(width) + " x " +
                                std::to_string(height) + " px, expected at least one pixel an area");
  }
  split(width, columns, column_of_, column_begin_);
  split(height, rows, row_of_, row_begin_);
}

int AreaGrid::pixelsIn(int area) const {
  const int row = area / columns_;
  const int column = area % columns_;
  return (row_begin_[row + 1] - row_begin_[row]) * (column_begin_[column + 1] - column_begin_[column]);
}

}  // namespace laparoscope_servo::image
