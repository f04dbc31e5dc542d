// The printed board by which a camera is calibrated: a chessboard, or one with ArUco markers in its white squares
// (ChArUco), of which a part is enough.
#pragma once

#include <opencv2/core.hpp>
#include <ostream>
#include <vector>

namespace laparoscope_servo {

struct Board {
  cv::Size corners{9, 6};  // inner corners: one less than squares, each way
  double square = 0.004;   // m, side of a square
  bool markers = false;    // those of OpenCV's DICT_4X4_250 in order, 3/4 of a square wide
};

// Throws std::invalid_argument for fewer than 3 or more than 100 corners each way, and for a side that is not positive;
// with markers also for more than 250 of them, and for an odd number of rows of corners, whose markers OpenCV 4.6 puts
// into other squares than 4.2.
void checkBoard(const Board& board);

// Writes an SVG in true size, to be printed without scaling; the white margin is part of the board.
void writeBoard(const Board& board, std::ostream& stream);

// Places of the corners on the board, m, by their number.
std::vector<cv::Point3f> cornerPlaces(const Board& board);

struct SeenCorners {
  std::vector<int> numbers;         // rising
  std::vector<cv::Point2f> points;  // px
};

// The corners in a grey picture of 8 bit. Of a chessboard all or none; of one with markers none, or more than a row or
// a column has.
SeenCorners findCorners(const Board& board, const cv::Mat& picture);

}  // namespace laparoscope_servo
