#include "motion/usable_pixels.h"

#include <gtest/gtest.h>

namespace laparoscope_servo::motion {
namespace {

constexpr int kBright = 250, kDarkness = 20;

cv::Mat grey(int value = 120) {
  return cv::Mat(120, 160, CV_8UC1, cv::Scalar(value));
}

UsablePixels lookedAt(const cv::Mat& image, const cv::Mat& mask = cv::Mat()) {
  UsablePixels usable;
  usable.look(image, mask, kBright, kDarkness);
  return usable;
}

TEST(UsablePixels, SquaresGrowWithTheImage) {
  EXPECT_EQ(UsablePixels::sideFor({320, 240}), 4);
  EXPECT_EQ(UsablePixels::sideFor({640, 480}), 4);
  EXPECT_EQ(UsablePixels::sideFor({1280, 720}), 8);
  EXPECT_EQ(UsablePixels::sideFor({1920, 1080}), 16);
}

TEST(UsablePixels, AllOfAPlainImageIsUsable) {
  const UsablePixels usable = lookedAt(grey());
  EXPECT_TRUE(usable.all());
  EXPECT_EQ(usable.squares().size(), cv::Size(40, 30));
}

// One pixel: its square and those around it.
TEST(UsablePixels, LeavesOutWhatIsNearAHighlight) {
  cv::Mat image = grey();
  image.at<unsigned char>(41, 82) = kBright;
  const UsablePixels usable = lookedAt(image);
  EXPECT_FALSE(usable.all());
  for (int j = 0; j < 30; ++j) {
    for (int i = 0; i < 40; ++i) {
      const bool near = std::abs(j - 10) <= 1 && std::abs(i - 20) <= 1;
      EXPECT_EQ(usable.squares()(j, i), near ? 0 : 1) << i << ", " << j;
    }
  }
}

TEST(UsablePixels, OneChannelIsEnoughForAHighlight) {
  cv::Mat image(120, 160, CV_8UC3, cv::Scalar(90, 100, 150));
  image.at<cv::Vec3b>(2, 2)[2] = 255;
  EXPECT_EQ(lookedAt(image).squares()(0, 0), 0);
  EXPECT_EQ(lookedAt(image).squares()(5, 5), 1);
}

TEST(UsablePixels, AnyPixelOfASquareIsEnough) {
  for (int pixel = 0; pixel < 16; ++pixel) {
    for (int channel = 0; channel < 3; ++channel) {
      cv::Mat image(120, 160, CV_8UC3, cv::Scalar(90, 100, 150));
      image.at<cv::Vec3b>(40 + pixel / 4, 80 + pixel % 4)[channel] = 255;
      const Squares squares = lookedAt(image).squares();
      EXPECT_EQ(cv::countNonZero(squares == 0), 9) << pixel << ", " << channel;
      EXPECT_EQ(squares(10, 20), 0) << pixel << ", " << channel;
      EXPECT_EQ(squares(9, 19) + squares(11, 21), 0) << pixel << ", " << channel;
    }
  }
}

TEST(UsablePixels, DarkIsWhereEveryChannelIs) {
  cv::Mat image(120, 160, CV_8UC3, cv::Scalar(5, 5, 60));
  image(cv::Rect(0, 0, 40, 40)).setTo(cv::Scalar(5, 5, 20));
  const UsablePixels usable = lookedAt(image);
  EXPECT_EQ(usable.squares()(3, 3), 0);
  EXPECT_EQ(usable.squares()(10, 10), 0) << "beside the darkness";
  EXPECT_EQ(usable.squares()(11, 11), 1);
}

TEST(UsablePixels, LeavesOutWhatTheMaskCovers) {
  cv::Mat mask = cv::Mat::zeros(120, 160, CV_8UC1);
  mask.at<unsigned char>(100, 100) = 1;
  EXPECT_EQ(lookedAt(grey(), mask).squares()(25, 25), 0);
  EXPECT_EQ(lookedAt(grey(), mask).squares()(20, 20), 1);
}

TEST(UsablePixels, ALastColumnThatIsNotFullCounts) {
  cv::Mat image(121, 162, CV_8UC1, cv::Scalar(120));
  image.at<unsigned char>(120, 161) = 255;
  const UsablePixels usable = lookedAt(image);
  ASSERT_EQ(usable.squares().size(), cv::Size(41, 31));
  EXPECT_EQ(usable.squares()(30, 40), 0);
}

TEST(JointlyUsable, TheCurrentImagesHighlightsLieWhereTheMotionTakesThem) {
  cv::Mat image = grey();
  image(cv::Rect(80, 40, 4, 4)).setTo(255);
  const UsablePixels reference = lookedAt(grey()), current = lookedAt(image);
  Eigen::Matrix3d shift = Eigen::Matrix3d::Identity();
  shift(0, 2) = 20.0;
  Squares joint;
  const JointUse use = jointlyUsable(reference, current, shift, nullptr, joint);
  EXPECT_EQ(joint(10, 15), 0) << "20 px to the left of the highlight";
  EXPECT_EQ(joint(10, 20), 1);
  EXPECT_NEAR(use.usable, 1.0 - 9.0 / 1200.0, 1e-9);
}

TEST(JointlyUsable, ARegionHasItsAreaInTheImage) {
  const UsablePixels plain = lookedAt(grey());
  const geometry::Quadrilateral region = geometry::Rectangle{120.0, 80.0, 80.0, 80.0}.corners();  // a quarter is inside
  Squares joint;
  const JointUse use = jointlyUsable(plain, plain, Eigen::Matrix3d::Identity(), &region, joint);
  EXPECT_NEAR(use.within, 1600.0, 1e-9);
  EXPECT_EQ(use.usable, 1.0);
  EXPECT_EQ(joint(25, 35), 1);
  EXPECT_EQ(joint(5, 5), 0);
}

}  // namespace
}  // namespace laparoscope_servo::motion
