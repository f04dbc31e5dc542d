#include "features/points/point_image.h"

#include <gtest/gtest.h>

#include <limits>

namespace laparoscope_servo::features {
namespace {

TEST(PointImage, DoesNotUseWhatIsSaturatedInAnyChannelNorItsSurroundings) {
  cv::Mat image(60, 80, CV_8UC3, cv::Scalar(90, 80, 120));
  image.at<cv::Vec3b>(20, 30)[2] = 250;
  PointImage seen;
  seen.take(image, 3, 250);
  EXPECT_EQ(cv::countNonZero(seen.usable() == 0), 25);
  EXPECT_FALSE(seen.isUsable(30.0, 20.0));
  EXPECT_FALSE(seen.isUsable(32.4, 17.6));
  EXPECT_TRUE(seen.isUsable(32.6, 20.0));
  EXPECT_TRUE(seen.isUsable(30.0, 17.4));
  seen.take(image, 3, 251);
  EXPECT_TRUE(seen.isUsable(30.0, 20.0));
}

TEST(PointImage, MarksAHighlightAtTheBorder) {
  cv::Mat image(60, 80, CV_8UC1, cv::Scalar(90));
  image.at<unsigned char>(0, 79) = 255;
  PointImage seen;
  seen.take(image, 2, 250);
  EXPECT_EQ(cv::countNonZero(seen.usable() == 0), 9);
}

TEST(PointImage, NothingOutsideIsUsable) {
  PointImage seen;
  seen.take(cv::Mat(60, 80, CV_8UC1, cv::Scalar(90)), 3, 250);
  EXPECT_TRUE(seen.isUsable(0.0, 0.0));
  EXPECT_TRUE(seen.isUsable(79.4, 59.4));
  EXPECT_FALSE(seen.isUsable(79.6, 30.0));
  EXPECT_FALSE(seen.isUsable(-0.6, 30.0));
  EXPECT_FALSE(seen.isUsable(std::numeric_limits<double>::quiet_NaN(), 30.0));
  EXPECT_FALSE(seen.holds({40.0, 59.1}));
  EXPECT_TRUE(seen.holds({79.0, 59.0}));
}

TEST(PointImage, ASmallImageHasFewerLevels) {
  PointImage seen;
  seen.take(cv::Mat(60, 200, CV_8UC1, cv::Scalar(90)), 5, 250);
  EXPECT_EQ(seen.levels(), 2);  // 30 px, and 15 would be too small
  seen.take(cv::Mat(8, 8, CV_8UC1, cv::Scalar(90)), 5, 250);
  EXPECT_EQ(seen.levels(), 1);
  seen.take(cv::Mat(480, 640, CV_8UC1, cv::Scalar(90)), 4, 250);
  EXPECT_EQ(seen.levels(), 4);
}

}  // namespace
}  // namespace laparoscope_servo::features
