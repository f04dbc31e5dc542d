#include "features/points/window.h"

#include <gtest/gtest.h>

#include <cmath>

#include "seen.h"

namespace laparoscope_servo::features {
namespace {

// Grey levels 10 + u + 2 v, which every smoothing keeps.
PointImage slope() {
  cv::Mat image(60, 60, CV_8UC1);
  image.forEach<unsigned char>(
      [](unsigned char& value, const int* at) { value = static_cast<unsigned char>(10 + at[1] + 2 * at[0]); });
  return seen(image);
}

std::size_t index(const Window& window, int i, int j) {
  return static_cast<std::size_t>((j + window.half()) * window.stride() + i + window.half());
}

TEST(Window, SamplesBetweenPixelsWithGradients) {
  const PointImage image = slope();
  Window window(4);
  Eigen::Matrix2d a;
  a << 0.9, -0.3, 0.2, 1.1;
  EXPECT_EQ(window.sample(image, 0, {30.25, 20.5}, a), 1.0);
  for (int j = -4; j <= 4; ++j) {
    for (int i = -4; i <= 4; ++i) {
      const Eigen::Vector2d p = Eigen::Vector2d(30.25, 20.5) + a * Eigen::Vector2d(i, j);
      EXPECT_NEAR(window.values()[index(window, i, j)], 10.0 + p.x() + 2.0 * p.y(), 1e-3);
      // By the window's own pixels: the image's gradient (1, 2) through a.
      EXPECT_NEAR(window.gradientX()[index(window, i, j)], 0.9 + 2.0 * 0.2, 1e-3);
      EXPECT_NEAR(window.gradientY()[index(window, i, j)], -0.3 + 2.0 * 1.1, 1e-3);
    }
  }
  EXPECT_NEAR(window.mean(), 10.0 + 30.25 + 41.0, 1e-3);
}

TEST(Window, TakesPlacesInPixelsOfTheImageOnEveryLevel) {
  const PointImage image = slope();
  Window window(3);
  window.sample(image, 1, {30.5, 24.0}, 2.0 * Eigen::Matrix2d::Identity());
  EXPECT_NEAR(window.values()[index(window, 0, 0)], 10.0 + 30.5 + 48.0, 0.01);
  EXPECT_NEAR(window.gradientX()[index(window, 0, 0)], 2.0, 0.01);
}

TEST(Window, WhatIsPaddedOrOutsideOrSaturatedIsNotValid) {
  cv::Mat flat(60, 60, CV_8UC1, cv::Scalar(90));
  flat.at<unsigned char>(10, 10) = 255;
  const PointImage image = seen(flat);
  Window window(4);
  const Eigen::Matrix2d one = Eigen::Matrix2d::Identity();
  // Two columns of nine lie outside.
  EXPECT_NEAR(window.sample(image, 0, {2.0, 40.0}, one), 7.0 / 9.0, 1e-9);
  EXPECT_EQ(window.valid()[index(window, -3, 0)], 0.0f);
  EXPECT_EQ(window.valid()[index(window, -2, 0)], 1.0f);
  EXPECT_EQ(window.valid()[static_cast<std::size_t>(window.side())], 0.0f);
  EXPECT_NEAR(window.sample(image, 0, {12.0, 12.0}, one), 1.0 - 25.0 / 81.0, 1e-9);
  // The mean leaves it out, beyond where the highlight is smoothed to.
  EXPECT_NEAR(window.mean(), 90.0, 1e-3);
  EXPECT_NEAR(window.contrast(), 0.0, 1e-2);
}

TEST(Window, TellsValuesBetweenItsPixelsAndNothingBeyond) {
  const PointImage image = slope();
  Window window(4);
  window.sample(image, 0, {30.0, 20.0}, Eigen::Matrix2d::Identity());
  float value = 0.0f;
  ASSERT_TRUE(window.at(1.5, -2.25, value));
  EXPECT_NEAR(value, 10.0 + 31.5 + 2.0 * 17.75, 1e-3);
  EXPECT_TRUE(window.at(4.0, 4.0, value));
  EXPECT_FALSE(window.at(4.1, 0.0, value));
  EXPECT_FALSE(window.at(0.0, -4.1, value));
}

TEST(Window, APlaceThatIsNotFiniteShowsNothing) {
  const PointImage image = slope();
  Window window(4);
  const double nan = std::nan("");
  EXPECT_EQ(window.sample(image, 0, {nan, 20.0}, Eigen::Matrix2d::Identity()), 0.0);
  EXPECT_EQ(window.sample(image, 0, {30.0, 20.0}, Eigen::Matrix2d::Constant(nan)), 0.0);
  EXPECT_EQ(window.sample(image, 0, {1e30, -1e30}, Eigen::Matrix2d::Identity()), 0.0);
}

}  // namespace
}  // namespace laparoscope_servo::features
