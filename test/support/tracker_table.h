// Lines of the table that the offline tool writes.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <sstream>
#include <string>

namespace laparoscope_servo::test_support {

// All but processing_time, which differs from run to run.
inline std::string withoutTime(const std::string& line) {
  constexpr int kProcessingTime = 15;
  std::size_t begin = 0;
  for (int column = 0; column < kProcessingTime; ++column) begin = line.find(',', begin) + 1;
  return line.substr(0, begin) + line.substr(line.find(',', begin));
}

// G of a line.
inline Eigen::Matrix3d homographyIn(const std::string& line) {
  std::istringstream cells(line);
  std::string cell;
  for (int k = 0; k < 3; ++k) std::getline(cells, cell, ',');  // frame, stamp, state
  Eigen::Matrix3d g;
  for (int k = 0; k < 9; ++k) {
    std::getline(cells, cell, ',');
    g(k / 3, k % 3) = std::stod(cell);
  }
  return g;
}

}  // namespace laparoscope_servo::test_support
