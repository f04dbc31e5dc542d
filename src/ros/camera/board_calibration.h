// The intrinsics of a camera from pictures of a printed chessboard.
#pragma once

#include <sensor_msgs/CameraInfo.h>

#include <opencv2/core.hpp>
#include <ostream>
#include <string>
#include <vector>

namespace laparoscope_servo {

struct Board {
  cv::Size corners{9, 6};  // inner corners: one less than squares, each way
  double square = 0.004;   // m, side of a square
};

// Throws std::invalid_argument for less than 3 corners each way, more than 100, and a side that is not positive.
void checkBoard(const Board& board);

// An SVG in true size, to be printed without scaling; the white margin is part of it.
void writeBoard(const Board& board, std::ostream& stream);

// Keeps the pictures that show the board in a place or a pose of its own.
class BoardViews {
 public:
  explicit BoardViews(const Board& board) : board_(board) {}

  enum class Verdict { kTaken, kNoBoard, kLikeAnother, kOtherSize, kEnough };
  // `picture`: 8 bit, grey or blue-green-red.
  Verdict add(const cv::Mat& picture);

  const Board& board() const { return board_; }
  const std::vector<std::vector<cv::Point2f>>& corners() const { return corners_; }
  cv::Size size() const { return size_; }
  // Share of the picture, cut into 6 x 6 cells, in which a corner was seen.
  double coverage() const;

 private:
  Board board_;
  cv::Size size_;
  std::vector<std::vector<cv::Point2f>> corners_;  // px, of each picture taken
};

struct BoardCalibration {
  sensor_msgs::CameraInfo info;
  double error = 0.0;         // px, root mean square, of corners to where they should be
  double focal_stddev = 0.0;  // px
};

// `rational`: eight coefficients of distortion instead of five. Throws std::runtime_error when the views do not
// determine the camera: fewer than 8, an error above 1.5 px, a focal length that is not known to 2 %.
BoardCalibration calibrate(const BoardViews& views, bool rational);

}  // namespace laparoscope_servo
