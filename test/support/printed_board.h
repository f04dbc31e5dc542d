// A board as it comes out of the printer, from the drawing that is written.
#pragma once

#include <cmath>
#include <cstdio>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <sstream>
#include <stdexcept>
#include <string>

#include "ros/camera/board.h"
#include "support/board_pictures.h"

namespace laparoscope_servo::test_support {

// Whether a place is black, in squares from the board's upper left edge.
inline BoardInk printed(const Board& board) {
  std::stringstream drawing;
  writeBoard(board, drawing);
  cv::Mat cells;
  int modules = 0;  // of a square
  for (std::string line; std::getline(drawing, line);) {
    cv::Rect box;
    const std::size_t view = line.find("viewBox=\"0 0 ");
    if (view != std::string::npos) {
      int width = 0, height = 0;
      std::sscanf(line.c_str() + view, "viewBox=\"0 0 %d %d\"", &width, &height);
      modules = width / (board.corners.width + 3);
      cells = cv::Mat(height, width, CV_8UC1, cv::Scalar(255));
    } else if (std::sscanf(line.c_str(), "<rect x=\"%d\" y=\"%d\" width=\"%d\" height=\"%d\"/>", &box.x, &box.y,
                           &box.width, &box.height) == 4) {
      cells(box).setTo(0);
    }
  }
  if (modules == 0) throw std::runtime_error("the drawing of the board cannot be read");
  return [cells, modules](double u, double v) {
    return cells.at<std::uint8_t>(static_cast<int>(std::floor((v + 1.0) * modules)),
                                  static_cast<int>(std::floor((u + 1.0) * modules))) == 0;
  };
}

}  // namespace laparoscope_servo::test_support
