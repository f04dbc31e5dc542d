#include "ros/camera/board_calibration.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "support/board_pictures.h"
#include "support/printed_board.h"

namespace laparoscope_servo {
namespace {

using test_support::BoardCamera;
using test_support::boardPicture;
using test_support::boardPictures;

TEST(BoardCalibration, FindsTheCameraThatTookThePictures) {
  const BoardCamera camera;
  BoardViews views(Board{});
  for (const cv::Mat& picture : boardPictures(camera)) views.add(picture);
  ASSERT_GE(views.views().size(), 8u);
  EXPECT_GT(views.coverage(), 0.4);
  const BoardCalibration result = calibrate(views, false);
  EXPECT_LT(result.error, 0.3);
  EXPECT_NEAR(result.info.K[0], 520.0, 5.0);
  EXPECT_NEAR(result.info.K[4], 525.0, 5.0);
  EXPECT_NEAR(result.info.K[2], 330.0, 5.0);
  EXPECT_NEAR(result.info.K[5], 235.0, 5.0);
  ASSERT_EQ(result.info.D.size(), 5u);
  EXPECT_NEAR(result.info.D[0], -0.2, 0.05);
  EXPECT_EQ(result.info.width, 640u);
  EXPECT_EQ(result.info.height, 480u);
  EXPECT_EQ(result.info.distortion_model, "plumb_bob");
  EXPECT_GT(result.info.P[0], 300.0);
  EXPECT_EQ(result.info.P[10], 1.0);
  EXPECT_EQ(result.info.R[4], 1.0);
}

TEST(BoardCalibration, CountsAViewOnceAndPicturesWithoutABoardNotAtAll) {
  const BoardCamera camera;
  BoardViews views(Board{});
  const cv::Mat picture = boardPicture(camera, {0.1, 0.2, 0.0}, {-0.016, -0.01, 0.07});
  EXPECT_EQ(views.add(cv::Mat(480, 640, CV_8UC1, cv::Scalar(90))), BoardViews::Verdict::kNoBoard);
  EXPECT_EQ(views.add(picture), BoardViews::Verdict::kTaken);
  EXPECT_EQ(views.add(picture), BoardViews::Verdict::kLikeAnother);
  EXPECT_EQ(views.add(picture(cv::Rect(0, 0, 600, 480))), BoardViews::Verdict::kOtherSize);
  try {
    calibrate(views, false);
    FAIL() << "one view is not enough";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("1 different places, expected 8"), std::string::npos) << error.what();
  }
}

// Where a part of a chessboard is beyond the picture's edge, there is no board.
TEST(BoardCalibration, ABoardWithMarkersMayBeHalfOutOfThePicture) {
  const BoardCamera camera;
  Board board;
  board.markers = true;
  BoardViews views(board), without(Board{});
  for (const cv::Mat& picture : boardPictures(camera, test_support::printed(board), 0.034)) views.add(picture);
  for (const cv::Mat& picture : boardPictures(camera, test_support::chessboard, 0.034)) without.add(picture);
  EXPECT_LT(without.views().size(), 8u) << "it cannot be calibrated by them";
  ASSERT_GE(views.views().size(), 10u);
  std::size_t whole = 0;
  for (const SeenCorners& view : views.views()) whole += view.numbers.size() == 54;
  EXPECT_LT(whole, views.views().size());
  EXPECT_GT(views.coverage(), 0.9);
  const BoardCalibration result = calibrate(views, false);
  EXPECT_LT(result.error, 0.6);
  EXPECT_NEAR(result.info.K[0], 520.0, 5.0);
  EXPECT_NEAR(result.info.K[4], 525.0, 5.0);
  EXPECT_NEAR(result.info.K[2], 330.0, 8.0);
  EXPECT_NEAR(result.info.K[5], 235.0, 8.0);
  EXPECT_NEAR(result.info.D[0], -0.2, 0.03);
}

}  // namespace
}  // namespace laparoscope_servo
