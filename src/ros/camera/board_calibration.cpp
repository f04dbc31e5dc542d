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

// Mean distance, px, between the two places of each corner that both show; infinite when they share none.
double distance(const SeenCorners& a, const SeenCorners& b) {
  double sum = 0.0;
  std::size_t shared = 0;
  for (std::size_t k = 0, other = 0; k < a.numbers.size(); ++k) {
    while (other < b.numbers.size() && b.numbers[other] < a.numbers[k]) ++other;
    if (other == b.numbers.size() || b.numbers[other] != a.numbers[k]) continue;
    sum += cv::norm(a.points[k] - b.points[other]);
    ++shared;
  }
  return shared > 0 ? sum / static_cast<double>(shared) : std::numeric_limits<double>::infinity();
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

BoardViews::Verdict BoardViews::add(const cv::Mat& picture) {
  if (views_.size() >= kMost) return Verdict::kEnough;
  if (views_.empty()) size_ = picture.size();
  if (picture.size() != size_) return Verdict::kOtherSize;
  cv::Mat grey = picture;
  if (picture.channels() == 3) cv::cvtColor(picture, grey, cv::COLOR_BGR2GRAY);
  const SeenCorners found = findCorners(board_, grey);
  if (found.points.empty()) return Verdict::kNoBoard;
  for (const SeenCorners& other : views_) {
    if (distance(found, other) < kDifferent * size_.width) return Verdict::kLikeAnother;
  }
  views_.push_back(found);
  return Verdict::kTaken;
}

double BoardViews::coverage() const {
  std::set<int> cells;
  for (const SeenCorners& view : views_) {
    for (const cv::Point2f& corner : view.points) {
      const int x = std::clamp(static_cast<int>(kCells * corner.x / static_cast<float>(size_.width)), 0, kCells - 1);
      const int y = std::clamp(static_cast<int>(kCells * corner.y / static_cast<float>(size_.height)), 0, kCells - 1);
      cells.insert(kCells * y + x);
    }
  }
  return static_cast<double>(cells.size()) / (kCells * kCells);
}

BoardCalibration calibrate(const BoardViews& views, bool rational) {
  const std::size_t count = views.views().size();
  if (count < kFewest) {
    throw std::runtime_error("the board was seen in " + std::to_string(count) + " different places, expected " +
                             std::to_string(kFewest) + " or more: move and tilt it between the pictures");
  }
  const std::vector<cv::Point3f> places = cornerPlaces(views.board());
  std::vector<std::vector<cv::Point3f>> board;
  std::vector<std::vector<cv::Point2f>> corners;
  for (const SeenCorners& view : views.views()) {
    corners.push_back(view.points);
    board.emplace_back();
    for (const int number : view.numbers) board.back().push_back(places[static_cast<std::size_t>(number)]);
  }
  cv::Mat k;
  cv::Mat d;
  cv::Mat deviations;
  std::vector<cv::Mat> rotations;
  std::vector<cv::Mat> translations;
  BoardCalibration result;
  result.error = cv::calibrateCamera(board, corners, views.size(), k, d, rotations, translations, deviations,
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
