#include "ros/camera/board.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <sstream>
#include <stdexcept>

#include "support/printed_board.h"

namespace laparoscope_servo {
namespace {

using test_support::BoardCamera;
using test_support::boardPicture;

Board withMarkers(const cv::Size& corners = {9, 6}) {
  Board board{corners, 0.004};
  board.markers = true;
  return board;
}

TEST(Board, OneThatCannotBeIsRefused) {
  EXPECT_NO_THROW(checkBoard(Board{}));
  EXPECT_NO_THROW(checkBoard(withMarkers()));
  EXPECT_NO_THROW(checkBoard(Board{{9, 5}, 0.004}));
  EXPECT_THROW(checkBoard(Board{{2, 6}, 0.004}), std::invalid_argument);
  EXPECT_THROW(checkBoard(Board{{9, 600}, 0.004}), std::invalid_argument);
  EXPECT_THROW(checkBoard(Board{{9, 6}, 0.0}), std::invalid_argument);
  EXPECT_THROW(checkBoard(Board{{9, 6}, std::nan("")}), std::invalid_argument);
  EXPECT_THROW(checkBoard(withMarkers({9, 5})), std::invalid_argument);
  EXPECT_THROW(checkBoard(withMarkers({30, 20})), std::invalid_argument) << "325 markers";
}

TEST(Board, IsPrintedInTrueSize) {
  std::ostringstream stream;
  writeBoard(Board{{9, 6}, 0.004}, stream);
  const std::string text = stream.str();
  EXPECT_NE(text.find("width=\"48mm\" height=\"36mm\""), std::string::npos) << text;
  std::size_t squares = 0;
  for (std::size_t at = text.find("width=\"1\""); at != std::string::npos; at = text.find("width=\"1\"", at + 1))
    ++squares;
  EXPECT_EQ(squares, 35u) << "half of 10 x 7";
  std::ostringstream with_markers;
  writeBoard(withMarkers(), with_markers);
  EXPECT_NE(with_markers.str().find("width=\"48mm\" height=\"36mm\""), std::string::npos);
}

TEST(Board, MarkersStandInTheWhiteSquares) {
  const auto ink = test_support::printed(withMarkers());
  for (int v = 0; v < 7; ++v) {
    for (int u = 0; u < 10; ++u) {
      const bool black = test_support::chessboard(u, v);
      EXPECT_EQ(ink(u + 0.05, v + 0.5), black) << u << ' ' << v << ": the rim of a square";
      EXPECT_EQ(ink(u + 0.2, v + 0.5), true) << u << ' ' << v << ": the rim of a marker, or a black square";
    }
  }
}

// A pose explains all corners only where each has the number of its place.
TEST(Board, CornersHaveTheNumbersOfTheirPlaces) {
  const BoardCamera camera;
  for (const Board& board : {Board{}, withMarkers()}) {
    const cv::Mat picture =
        boardPicture(camera, {0.2, -0.3, 0.1}, {-0.016, -0.010, 0.07}, test_support::printed(board));
    const SeenCorners seen = findCorners(board, picture);
    ASSERT_EQ(seen.points.size(), 54u) << "with markers: " << board.markers;
    ASSERT_TRUE(std::is_sorted(seen.numbers.begin(), seen.numbers.end()));
    const std::vector<cv::Point3f> places = cornerPlaces(board);
    cv::Vec3d r, t;
    ASSERT_TRUE(cv::solvePnP(places, seen.points, camera.k, camera.d, r, t));
    std::vector<cv::Point2f> expected;
    cv::projectPoints(places, r, t, camera.k, camera.d, expected);
    for (std::size_t k = 0; k < expected.size(); ++k)
      EXPECT_LT(cv::norm(seen.points[k] - expected[k]), 1.0) << k << ": the next one is 30 px away";
  }
}

TEST(Board, APartWithMarkersHasTheNumbersOfThatPart) {
  const Board board = withMarkers();
  const cv::Mat picture =
      boardPicture(BoardCamera(), {0.1, 0.2, 0.0}, {-0.016, -0.010, 0.07}, test_support::printed(board));
  const SeenCorners whole = findCorners(board, picture);
  cv::Mat part = picture.clone();
  part.colRange(0, 300).setTo(110);
  const SeenCorners seen = findCorners(board, part);
  ASSERT_GT(seen.numbers.size(), 10u);
  ASSERT_LT(seen.numbers.size(), 45u);
  for (std::size_t k = 0; k < seen.numbers.size(); ++k) {
    EXPECT_LT(cv::norm(seen.points[k] - whole.points[static_cast<std::size_t>(seen.numbers[k])]), 0.5);
  }
  part.colRange(0, 420).setTo(110);
  EXPECT_LT(findCorners(board, part).numbers.size(), seen.numbers.size());
}

TEST(Board, APictureWithoutItHasNoCorners) {
  const cv::Mat nothing(480, 640, CV_8UC1, cv::Scalar(90));
  EXPECT_TRUE(findCorners(Board{}, nothing).numbers.empty());
  EXPECT_TRUE(findCorners(withMarkers(), nothing).numbers.empty());
  // Another board: a chessboard without markers.
  const cv::Mat other = boardPicture(BoardCamera(), {0.1, 0.2, 0.0}, {-0.016, -0.01, 0.07});
  EXPECT_TRUE(findCorners(withMarkers(), other).numbers.empty());
}

}  // namespace
}  // namespace laparoscope_servo
