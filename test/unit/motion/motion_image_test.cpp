#include "motion/motion_image.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace laparoscope_servo::motion {
namespace {

TEST(MotionImage, ALargerImageHasACoarserFinestLevel) {
  EXPECT_EQ(finestScale({640, 480}, 310000), 1);
  EXPECT_EQ(finestScale({1280, 720}, 310000), 2);
  EXPECT_EQ(finestScale({1920, 1080}, 310000), 4);
}

TEST(MotionImage, ItsCoarsestLevelIsLargeEnoughForAQuadraticMotion) {
  MotionImage image;
  image.take(cv::Mat(480, 640, CV_8UC1, cv::Scalar(90)), cv::Mat(), MotionConfig());
  ASSERT_EQ(image.pyramid.levels(), 4);
  EXPECT_EQ(image.pyramid.level(0).rows, 480);
  EXPECT_EQ(image.pyramid.level(3).rows, 60);
}

TEST(MotionImage, OfAnImageOfAnotherTypeIsRefused) {
  MotionImage image;
  EXPECT_THROW(image.take(cv::Mat(480, 640, CV_32FC1), cv::Mat(), MotionConfig()), std::invalid_argument);
}

}  // namespace
}  // namespace laparoscope_servo::motion
