// The intrinsics of a camera from pictures of a printed board.
#pragma once

#include <sensor_msgs/CameraInfo.h>

#include <opencv2/core.hpp>
#include <vector>

#include "ros/camera/board.h"

namespace laparoscope_servo {

// Keeps the pictures that show the board at a new place or in a new pose.
class BoardViews {
 public:
  explicit BoardViews(const Board& board) : board_(board) {}

  enum class Verdict { kTaken, kNoBoard, kLikeAnother, kOtherSize, kEnough };
  // `picture`: 8 bit, grey or blue-green-red.
  Verdict add(const cv::Mat& picture);

  const Board& board() const { return board_; }
  const std::vector<SeenCorners>& views() const { return views_; }
  cv::Size size() const { return size_; }
  // Share of the picture's 6 x 6 cells in which a corner was seen.
  double coverage() const;

 private:
  Board board_;
  cv::Size size_;
  std::vector<SeenCorners> views_;  // of each picture taken
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
