#include "ros/camera/board.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <opencv2/aruco/charuco.hpp>
#include <opencv2/calib3d.hpp>
#include <stdexcept>
#include <string>

#include "laparoscope_servo/validation/range.h"

namespace laparoscope_servo {

namespace {

using validation::numberText;

constexpr int kMarkers = 250;  // of the dictionary
constexpr int kModules = 8;    // of a square's side; the marker has 6, of which the outer ones are black
constexpr double kMarkerShare = 0.75;

cv::Size squaresOf(const Board& board) {
  return board.corners + cv::Size(1, 1);
}

cv::Ptr<cv::aruco::CharucoBoard> charucoBoard(const Board& board) {
  const auto side = static_cast<float>(board.square);
  const cv::Size squares = squaresOf(board);
  return cv::aruco::CharucoBoard::create(squares.width, squares.height, side, static_cast<float>(kMarkerShare) * side,
                                         cv::aruco::getPredefinedDictionary(cv::aruco::DICT_4X4_250));
}

// 0 where it is black; a pixel for each square, or for each module where there are markers.
cv::Mat pattern(const Board& board) {
  const cv::Size squares = squaresOf(board);
  if (!board.markers) {
    cv::Mat cells(squares, CV_8UC1);
    for (int y = 0; y < cells.rows; ++y) {
      for (int x = 0; x < cells.cols; ++x) cells.at<std::uint8_t>(y, x) = (x + y) % 2 == 0 ? 0 : 255;
    }
    return cells;
  }
  constexpr int kFine = 10;  // px of a module, whose middle is taken
  cv::Mat drawn;
  charucoBoard(board)->draw(squares * (kModules * kFine), drawn);
  cv::Mat cells(squares * kModules, CV_8UC1);
  for (int y = 0; y < cells.rows; ++y) {
    for (int x = 0; x < cells.cols; ++x)
      cells.at<std::uint8_t>(y, x) = drawn.at<std::uint8_t>(kFine * y + kFine / 2, kFine * x + kFine / 2);
  }
  return cells;
}

// Sorts the corners by number: the detector gives them in any order.
SeenCorners inOrder(const std::vector<int>& numbers, const std::vector<cv::Point2f>& points) {
  std::vector<std::size_t> order(numbers.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return numbers[a] < numbers[b]; });
  SeenCorners seen;
  for (const std::size_t k : order) {
    seen.numbers.push_back(numbers[k]);
    seen.points.push_back(points[k]);
  }
  return seen;
}

SeenCorners findBesideMarkers(const Board& board, const cv::Mat& picture) {
  const auto charuco = charucoBoard(board);
  std::vector<std::vector<cv::Point2f>> markers;
  std::vector<int> ids;
  cv::aruco::detectMarkers(picture, charuco->dictionary, markers, ids);
  if (ids.empty()) return {};
  std::vector<cv::Point2f> points;
  std::vector<int> numbers;
  cv::aruco::interpolateCornersCharuco(markers, ids, picture, charuco, points, numbers);
  const auto longest = static_cast<std::size_t>(std::max(board.corners.width, board.corners.height));
  return numbers.size() > longest ? inOrder(numbers, points) : SeenCorners();
}

}  // namespace

void checkBoard(const Board& board) {
  const auto usable = [](int count) { return count >= 3 && count <= 100; };
  const std::string corners = std::to_string(board.corners.width) + "x" + std::to_string(board.corners.height);
  if (!usable(board.corners.width) || !usable(board.corners.height))
    throw std::invalid_argument("a board of " + corners + " inner corners, expected 3 to 100 each way");
  if (!(board.square > 1e-4 && board.square < 1.0))
    throw std::invalid_argument("a square of " + numberText(board.square) + " m, expected 0.0001 to 1");
  if (!board.markers) return;
  if (board.corners.height % 2 != 0)
    throw std::invalid_argument("a board of " + corners +
                                " inner corners with markers, expected an even number of rows");
  if (squaresOf(board).area() / 2 > kMarkers) {
    throw std::invalid_argument("a board of " + corners + " inner corners has " +
                                std::to_string(squaresOf(board).area() / 2) + " markers, expected at most " +
                                std::to_string(kMarkers));
  }
}

void writeBoard(const Board& board, std::ostream& stream) {
  const cv::Mat cells = pattern(board);
  const int modules = cells.cols / squaresOf(board).width;  // of a square, the unit of the drawing
  const double side = 1e3 * board.square;
  const cv::Size whole = squaresOf(board) + cv::Size(2, 2);
  stream << "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" << numberText(whole.width * side) << "mm\" height=\""
         << numberText(whole.height * side) << "mm\" viewBox=\"0 0 " << modules * whole.width << ' '
         << modules * whole.height << "\" shape-rendering=\"crispEdges\">\n"
         << "<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n";
  for (int y = 0; y < cells.rows; ++y) {
    for (int x = 0, end = 0; x < cells.cols; x = end + 1) {
      for (end = x; end < cells.cols && cells.at<std::uint8_t>(y, end) == 0;) ++end;
      if (end == x) continue;
      stream << "<rect x=\"" << x + modules << "\" y=\"" << y + modules << "\" width=\"" << end - x
             << "\" height=\"1\"/>\n";
    }
  }
  stream << "</svg>\n";
}

std::vector<cv::Point3f> cornerPlaces(const Board& board) {
  if (board.markers) return charucoBoard(board)->chessboardCorners;
  std::vector<cv::Point3f> points;
  for (int y = 0; y < board.corners.height; ++y) {
    for (int x = 0; x < board.corners.width; ++x)
      points.emplace_back(static_cast<float>(x * board.square), static_cast<float>(y * board.square), 0.0F);
  }
  return points;
}

SeenCorners findCorners(const Board& board, const cv::Mat& picture) {
  if (board.markers) return findBesideMarkers(board, picture);
  SeenCorners seen;
  if (!cv::findChessboardCornersSB(picture, board.corners, seen.points, cv::CALIB_CB_NORMALIZE_IMAGE)) return {};
  seen.numbers.resize(seen.points.size());
  std::iota(seen.numbers.begin(), seen.numbers.end(), 0);
  return seen;
}

}  // namespace laparoscope_servo
