#include "model/instrument/grey_plane.h"

#include <gtest/gtest.h>

#include <cmath>

namespace laparoscope_servo::model {
namespace {

// Blue, green, red.
int levelOf(const cv::Vec3b& colour) {
  GreyPlane plane;
  plane.compute(cv::Mat(1, 1, CV_8UC3, cv::Scalar(colour[0], colour[1], colour[2])), {0, 0, 1, 1});
  return plane.plane()(0, 0);
}

// Grey has one level, but for what is nearly black.
TEST(GreyPlane, GreyIsOneLevelHoweverBright) {
  for (int level = 60; level < 256; level += 5)
    EXPECT_NEAR(levelOf(cv::Vec3b(static_cast<uchar>(level), static_cast<uchar>(level), static_cast<uchar>(level))),
                GreyPlane::kGrey, 0.1 * GreyPlane::kGrey)
        << level;
  EXPECT_LT(levelOf({5, 5, 5}), GreyPlane::kGrey / 2) << "what is nearly black may be anything";
  EXPECT_EQ(levelOf({0, 0, 0}), 0);
}

// The mean of blue and green over red, times kGrey; the red channel has 6 levels of doubt.
TEST(GreyPlane, IsTheRatioOfBlueAndGreenToRed) {
  for (const cv::Vec3b& c :
       {cv::Vec3b(60, 70, 170), cv::Vec3b(10, 200, 240), cv::Vec3b(0, 90, 255), cv::Vec3b(30, 0, 60)})
    EXPECT_NEAR(levelOf(c), GreyPlane::kGrey * 0.5 * (c[0] + c[1]) / (c[2] + 6.0), 1.0) << c;
  EXPECT_EQ(levelOf({255, 255, 10}), 255) << "what is bluer than the plane can tell";
  EXPECT_EQ(levelOf({255, 255, 0}), 255) << "no division by zero";
}

TEST(GreyPlane, RedIsLessAndBlueIsMoreThanGrey) {
  EXPECT_LT(levelOf({60, 70, 170}), GreyPlane::kGrey / 2) << "tissue";
  EXPECT_GT(levelOf({150, 120, 100}), GreyPlane::kGrey);
  EXPECT_EQ(levelOf({90, 30, 120}), levelOf({30, 90, 120})) << "blue and green count alike";
}

// Exposure does not matter: the edge of a shaft in the shade is as high as in the light.
TEST(GreyPlane, ExposureHardlyMatters) {
  for (const double exposure : {0.4, 0.6, 1.0}) {
    const auto scaled = [&](double value) { return static_cast<uchar>(std::lround(exposure * value)); };
    EXPECT_NEAR(levelOf({scaled(60), scaled(70), scaled(170)}), 70.0, 8.0) << exposure;
  }
}

TEST(GreyPlane, FillsItsPartAndLeavesTheRest) {
  const cv::Mat red(40, 50, CV_8UC3, cv::Scalar(60, 70, 170)), grey(40, 50, CV_8UC3, cv::Scalar(200, 200, 200));
  GreyPlane plane;
  plane.compute(red, {10, 5, 20, 30});
  EXPECT_EQ(cv::countNonZero(plane.plane()), 20 * 30);
  EXPECT_EQ(plane.plane()(5, 10), plane.plane()(34, 29));
  EXPECT_EQ(plane.plane()(4, 10), 0);
  EXPECT_EQ(plane.plane()(35, 29), 0);
  plane.compute(grey, {0, 0, 20, 40});
  EXPECT_GT(plane.plane()(20, 19), 150);
  EXPECT_LT(plane.plane()(20, 20), 100) << "of the image before";
}

// A part beyond the image is cut; images of another size begin with a new plane.
TEST(GreyPlane, KeepsToTheImage) {
  GreyPlane plane;
  plane.compute(cv::Mat(20, 30, CV_8UC3, cv::Scalar(200, 200, 200)), {-10, -10, 25, 1000});
  EXPECT_EQ(plane.plane().size(), cv::Size(30, 20));
  EXPECT_EQ(cv::countNonZero(plane.plane()), 15 * 20);
  plane.compute(cv::Mat(20, 30, CV_8UC3, cv::Scalar(200, 200, 200)), {100, 100, 5, 5});
  EXPECT_EQ(cv::countNonZero(plane.plane()), 15 * 20);
  plane.compute(cv::Mat(10, 10, CV_8UC3, cv::Scalar(200, 200, 200)), {0, 0, 1, 1});
  EXPECT_EQ(cv::countNonZero(plane.plane()), 1);
}

// A part of another image has rows that do not follow each other in memory.
TEST(GreyPlane, TakesAPartOfAnImage) {
  cv::Mat image(40, 50, CV_8UC3, cv::Scalar(60, 70, 170));
  image(cv::Rect(20, 10, 10, 10)).setTo(cv::Scalar(200, 200, 200));
  GreyPlane plane;
  plane.compute(image(cv::Rect(20, 10, 12, 12)), {0, 0, 12, 12});
  EXPECT_EQ(cv::countNonZero(plane.plane() > 150), 100);
}

}  // namespace
}  // namespace laparoscope_servo::model
