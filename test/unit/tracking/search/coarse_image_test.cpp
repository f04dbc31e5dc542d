#include "tracking/search/coarse_image.h"

#include <gtest/gtest.h>

namespace laparoscope_servo::tracking {
namespace {

TEST(CoarseImage, TheScaleIsTheLeastWholeOneThatIsSmallEnough) {
  EXPECT_EQ(coarseScale(cv::Size(300, 200), 60000), 1);
  EXPECT_EQ(coarseScale(cv::Size(301, 200), 60000), 2);
  EXPECT_EQ(coarseScale(cv::Size(1920, 1080), 60000), 6);
  EXPECT_EQ(coarseScale(cv::Size(4, 4), 60000), 1);
}

TEST(CoarseImage, APixelLiesInTheMiddleOfThoseThatItStandsFor) {
  cv::Mat1b image(20, 31, static_cast<uchar>(10));
  image(cv::Rect(9, 6, 3, 3)).setTo(70);
  const CoarseImage coarse = coarseImage(image, 3, image::kLuma, 250);
  ASSERT_EQ(coarse.grey.size(), cv::Size(10, 6));
  EXPECT_EQ(coarse.grey(2, 3), 70);
  EXPECT_EQ(coarse.grey(2, 2), 10);
  EXPECT_EQ(coarse.inImage(cv::Point2f(3.0f, 2.0f)), cv::Point2f(10.0f, 7.0f));
}

TEST(CoarseImage, NearHighlightsItIsNotUsable) {
  cv::Mat3b image(40, 40, cv::Vec3b(50, 60, 90));
  image(20, 10) = cv::Vec3b(50, 60, 252);
  const CoarseImage coarse = coarseImage(image, 1, image::kLuma, 250);
  EXPECT_EQ(coarse.usable(20, 10), 0);
  EXPECT_EQ(coarse.usable(20, 13), 0);
  EXPECT_EQ(coarse.usable(20, 14), 255);
  EXPECT_EQ(cv::countNonZero(coarseImage(image, 1, image::kLuma, 256).usable), 1600);
}

TEST(CoarseImage, ATinyImageLeavesNothing) {
  EXPECT_TRUE(coarseImage(cv::Mat1b(2, 5), 3, image::kLuma, 250).grey.empty());
}

TEST(OneChannel, AMixtureWithNegativeWeightsStaysInItsRange) {
  cv::Mat3b image(1, 3);
  image(0, 0) = cv::Vec3b(255, 0, 0);
  image(0, 1) = cv::Vec3b(0, 255, 255);
  image(0, 2) = cv::Vec3b(0, 0, 0);
  const cv::Mat1b grey = oneChannel(image, {-0.2f, 0.6f, 0.2f});
  EXPECT_EQ(grey(0, 0), 0);
  EXPECT_EQ(grey(0, 1), 255);
  EXPECT_NEAR(grey(0, 2), 51, 1);
}

}  // namespace
}  // namespace laparoscope_servo::tracking
