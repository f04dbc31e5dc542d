#include "ros/camera/board_calibration.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
#include <set>
#include <stdexcept>

#include "laparoscope_servo/validation/range.h"

namespace laparoscope_servo {

namespace {

using validation::numberText;

constexpr std::size_t kFewest = 8;
constexpr std::size_t kMost = 40;     // more views make it slow, but not more accurate
constexpr double kDifferent = 0.03;   // share of the picture's width by which the corners must have moved on average
constexpr double kWorstError = 1.5;   // px; a sharp picture of a flat board has about 0.2
constexpr double kWorstFocal = 0.02;  // share
constexpr int kCells = 6;

std::vector<cv::Point3f> cornersOf(const Board& board) {
  std::vector<cv::Point3f> points;
  for (int y = 0; y < board.corners.height; ++y) {
    for (int x = 0; x < board.corners.width; ++x) {
      points.emplace_back(static_cast<float>(x * board.square), static_cast<float>(y * board.square), 0.0F);
    }
  }
  return points;
}

double distance(const std::vector<cv::Point2f>& a, const std::vector<cv::Point2f>& b) {
  double sum = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) sum += cv::norm(a[k] - b[k]);
  return sum / static_cast<double>(a.size());
}

template <class Array>
void copyMatrix(const cv::Mat& matrix, Array& array) {
  for (int k = 0; k < static_cast<int>(array.size()); ++k) {
    array[static_cast<std::size_t>(k)] = matrix.at<double>(k / matrix.cols, k % matrix.cols);
  }
}

sensor_msgs::CameraInfo cameraInfo(const cv::Size& size, const cv::Mat& k, const cv::Mat& d, bool rational) {
  sensor_msgs::CameraInfo info;
  info.width = static_cast<std::uint32_t>(size.width);
  info.height = static_cast<std::uint32_t>(size.height);
  info.distortion_model = rational ? "rational_polynomial" : "plumb_bob";
  info.D.assign(d.begin<double>(), d.begin<double>() + (rational ? 8 : 5));
  copyMatrix(k, info.K);
  info.R = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  // As in camera_calibration: rectified pictures show no pixels from beyond the picture's edge.
  const cv::Mat rectified = cv::getOptimalNewCameraMatrix(k, d, size, 0.0);
  cv::Mat p = cv::Mat::zeros(3, 4, CV_64F);
  rectified.copyTo(p.colRange(0, 3));
  copyMatrix(p, info.P);
  return info;
}

}  // namespace

void checkBoard(const Board& board) {
  const auto usable = [](int count) { return count >= 3 && count <= 100; };
  if (!usable(board.corners.width) || !usable(board.corners.height)) {
    throw std::invalid_argument("a board of " + std::to_string(board.corners.width) + "x" +
                                std::to_string(board.corners.height) + " inner corners, expected 3 to 100 each way");
  }
  if (!(board.square > 1e-4 && board.square < 1.0))
    throw std::invalid_argument("a square of " + numberText(board.square) + " m, expected 0.0001 to 1");
}

void writeBoard(const Board& board, std::ostream& stream) {
  const double side = 1e3 * board.square;
  const int columns = board.corners.width + 1;
  const int rows = board.corners.height + 1;
  const std::string width = numberText((columns + 2) * side);
  const std::string height = numberText((rows + 2) * side);
  stream << "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" << width << "mm\" height=\"" << height
         << "mm\" viewBox=\"0 0 " << columns + 2 << ' ' << rows + 2 << "\">\n"
         << "<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n";
  for (int y = 0; y < rows; ++y) {
    for (int x = y % 2; x < columns; x += 2) {
      stream << "<rect x=\"" << x + 1 << "\" y=\"" << y + 1 << "\" width=\"1\" height=\"1\"/>\n";
    }
  }
  stream << "</svg>\n";
}

BoardViews::Verdict BoardViews::add(const cv::Mat& picture) {
  if (corners_.size() >= kMost) return Verdict::kEnough;
  if (corners_.empty()) size_ = picture.size();
  if (picture.size() != size_) return Verdict::kOtherSize;
  cv::Mat grey = picture;
  if (picture.channels() == 3) cv::cvtColor(picture, grey, cv::COLOR_BGR2GRAY);
  std::vector<cv::Point2f> found;
  if (!cv::findChessboardCornersSB(grey, board_.corners, found, cv::CALIB_CB_NORMALIZE_IMAGE)) return Verdict::kNoBoard;
  for (const auto& other : corners_) {
    if (distance(found, other) < kDifferent * size_.width) return Verdict::kLikeAnother;
  }
  corners_.push_back(found);
  return Verdict::kTaken;
}

double BoardViews::coverage() const {
  std::set<int> cells;
  for (const auto& view : corners_) {
    for (const cv::Point2f& corner : view) {
      const int x = std::clamp(static_cast<int>(kCells * corner.x / static_cast<float>(size_.width)), 0, kCells - 1);
      const int y = std::clamp(static_cast<int>(kCells * corner.y / static_cast<float>(size_.height)), 0, kCells - 1);
      cells.insert(kCells * y + x);
    }
  }
  return static_cast<double>(cells.size()) / (kCells * kCells);
}

BoardCalibration calibrate(const BoardViews& views, bool rational) {
  const std::size_t count = views.corners().size();
  if (count < kFewest) {
    throw std::runtime_error("the board was seen in " + std::to_string(count) + " different places, expected " +
                             std::to_string(kFewest) + " or more: move and tilt it between the pictures");
  }
  const std::vector<std::vector<cv::Point3f>> board(count, cornersOf(views.board()));
  cv::Mat k;
  cv::Mat d;
  cv::Mat deviations;
  std::vector<cv::Mat> rotations;
  std::vector<cv::Mat> translations;
  BoardCalibration result;
  result.error = cv::calibrateCamera(board, views.corners(), views.size(), k, d, rotations, translations, deviations,
                                     cv::noArray(), cv::noArray(), rational ? cv::CALIB_RATIONAL_MODEL : 0);
  result.focal_stddev = std::max(deviations.at<double>(0), deviations.at<double>(1));
  if (!(result.error <= kWorstError)) {
    throw std::runtime_error("the corners are " + numberText(result.error) + " px from where they should be, at most " +
                             numberText(kWorstError) + " was expected: is the board flat, and are the pictures sharp?");
  }
  const double focal = k.at<double>(0, 0);
  if (!(result.focal_stddev <= kWorstFocal * focal)) {
    throw std::runtime_error("the focal length is " + numberText(focal) + " px with a standard deviation of " +
                             numberText(result.focal_stddev) + ": tilt the board more, by 30 degrees to each side");
  }
  result.info = cameraInfo(views.size(), k, d, rational);
  return result;
}

}  // namespace laparoscope_servo
