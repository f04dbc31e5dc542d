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

// Throws std::invalid_argument for fewer than 3 or more than 100 corners each way, and for a side that is not positive.
void checkBoard(const Board& board);

// Writes an SVG in true size, to be printed without scaling; the white margin is part of the board.
void writeBoard(const Board& board, std::ostream& stream);

// Keeps the pictures that show the board at a new place or in a new pose.
class BoardViews {
 public:
  explicit BoardViews(const Board& board) : board_(board) {}

  enum class Verdict { kTaken, kNoBoard, kLikeAnother, kOtherSize, kEnough };
  // `picture`: 8 bit, grey or blue-green-red.
  Verdict add(const cv::Mat& picture);

  const Board& board() const { return board_; }
  const std::vector<std::vector<cv::Point2f>>& corners() const { return corners_; }
  cv::Size size() const { return size_; }
  // Share of the picture's 6 x 6 cells in which a corner was seen.
  double coverage() const;

 private:
  Board board_;
  cv::Size size_;
  std::vector<std::vector<cv::Point2f>> corners_;  // px, of each picture taken
};

struct BoardCalibration {
  sensor_msgs::CameraInfo info;
  double error = 0.0;         // px, root mean square reprojection error of the corners
  double focal_stddev = 0.0;  // px
};

// `rational`: eight coefficients of distortion instead of five. Throws std::runtime_error when the views do not
// determine the camera: fewer than 8, an error above 1.5 px, a focal length that is not known to 2 %.
BoardCalibration calibrate(const BoardViews& views, bool rational);

}  // namespace laparoscope_servo
