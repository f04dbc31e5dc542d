#include "ros/camera/board_calibration.h"

#include <gtest/gtest.h>

#include <sstream>
#include <stdexcept>

#include "support/board_pictures.h"

namespace laparoscope_servo {
namespace {

using test_support::BoardCamera;
using test_support::boardPicture;
using test_support::boardPictures;

TEST(BoardCalibration, FindsTheCameraThatTookThePictures) {
  const BoardCamera camera;
  BoardViews views(Board{{9, 6}, 0.004});
  for (const cv::Mat& picture : boardPictures(camera)) views.add(picture);
  ASSERT_GE(views.corners().size(), 8u);
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
  BoardViews views(Board{{9, 6}, 0.004});
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

TEST(BoardCalibration, ABoardThatIsNoneIsRefused) {
  EXPECT_NO_THROW(checkBoard(Board{}));
  EXPECT_THROW(checkBoard(Board{{2, 6}, 0.004}), std::invalid_argument);
  EXPECT_THROW(checkBoard(Board{{9, 600}, 0.004}), std::invalid_argument);
  EXPECT_THROW(checkBoard(Board{{9, 6}, 0.0}), std::invalid_argument);
  EXPECT_THROW(checkBoard(Board{{9, 6}, std::nan("")}), std::invalid_argument);
}

TEST(BoardCalibration, TheBoardIsPrintedInTrueSize) {
  std::ostringstream stream;
  writeBoard(Board{{9, 6}, 0.004}, stream);
  const std::string text = stream.str();
  EXPECT_NE(text.find("width=\"48mm\" height=\"36mm\""), std::string::npos) << text;
  std::size_t squares = 0;
  for (std::size_t at = text.find("width=\"1\""); at != std::string::npos; at = text.find("width=\"1\"", at + 1))
    ++squares;
  EXPECT_EQ(squares, 35u) << "half of 10 x 7";
}

}  // namespace
}  // namespace laparoscope_servo
