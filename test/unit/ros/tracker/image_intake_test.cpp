#include "ros/tracker/image_intake.h"

#include <gtest/gtest.h>

namespace laparoscope_servo {
namespace {

const cv::Mat kImage(24, 32, CV_8UC1, cv::Scalar(90));

TEST(ImageIntake, TimeIsThatOfTheStampsUntilTheyJumpBack) {
  ImageIntake intake(ImageFormat{}, tracking::InputConfig{});
  intake.pass(ros::Time(100.0), kImage);
  EXPECT_DOUBLE_EQ(intake.time(), 100.0);
  intake.pass(ros::Time(100.5), kImage);
  EXPECT_DOUBLE_EQ(intake.time(), 100.5);
  intake.clockJumpedBack();
  const ImageGate::Passed loop = intake.pass(ros::Time(10.0), kImage);
  EXPECT_TRUE(loop.loop);
  // It goes on by the last period.
  EXPECT_NEAR(intake.time(), 101.0, 1e-9);
  intake.pass(ros::Time(10.2), kImage);
  EXPECT_NEAR(intake.time(), 101.2, 1e-9);
}

TEST(ImageIntake, AnImageThatIsRefusedLeavesTheTime) {
  ImageIntake intake(ImageFormat{}, tracking::InputConfig{});
  intake.pass(ros::Time(100.0), kImage);
  EXPECT_THROW(intake.pass(ros::Time(50.0), kImage), ImageError);
  EXPECT_THROW(intake.pass(ros::Time(100.04), cv::Mat(12, 16, CV_8UC1)), ImageError);
  EXPECT_DOUBLE_EQ(intake.time(), 100.0);
}

TEST(ImageIntake, TheDepthOfPixelsIsEstimatedOrGiven) {
  const cv::Mat deep(24, 32, CV_16UC1, cv::Scalar(1023));
  ImageFormat format;
  format.bit_depth = 0;
  ImageIntake estimated(format, tracking::InputConfig{});
  EXPECT_EQ(estimated.decode(deep).at<std::uint8_t>(0, 0), 255);
  // It does not decrease with a dark picture.
  EXPECT_LT(estimated.decode(cv::Mat(24, 32, CV_16UC1, cv::Scalar(200))).at<std::uint8_t>(0, 0), 60);
  format.bit_depth = 16;
  ImageIntake given(format, tracking::InputConfig{});
  EXPECT_LT(given.decode(deep).at<std::uint8_t>(0, 0), 10);
}

}  // namespace
}  // namespace laparoscope_servo
