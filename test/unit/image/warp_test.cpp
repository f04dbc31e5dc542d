#include "laparoscope_servo/image/warp.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>

#include "laparoscope_servo/geometry/homography.h"

namespace laparoscope_servo::image {
namespace {

// Bilinear interpolation reproduces c0 + cx x + cy y + cxy x y within each pixel's square.
cv::Mat1f bilinearImage(int width, int height) {
  cv::Mat1f image(height, width);
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) image(v, u) = static_cast<float>(3.0 + 0.5 * u - 0.25 * v);
  }
  return image;
}

TEST(WarpBilinear, SamplesWhereTheHomographySays) {
  const cv::Mat1f image = bilinearImage(80, 60);
  Eigen::Matrix3d g;
  g << 0.9, 0.05, 12.3, -0.04, 1.1, 7.7, 0.0005, -0.0003, 1.0;
  for (const double scale : {1.0, 0.01, 300.0}) {  // a homography has no scale
    cv::Mat1f patch(30, 40), valid(30, 40);
    EXPECT_TRUE(warpBilinear(image, scale * g, patch, valid));
    for (int j = 0; j < 30; ++j) {
      for (int i = 0; i < 40; ++i) {
        const Eigen::Vector2d p = geometry::apply(g, Eigen::Vector2d(i, j));
        EXPECT_NEAR(patch(j, i), 3.0 + 0.5 * p.x() - 0.25 * p.y(), 2e-4);
        EXPECT_EQ(valid(j, i), 1.0f);
      }
    }
  }
}

TEST(WarpBilinear, IsExactOnPixelsUpToTheLast) {
  cv::Mat1f image(20, 30);
  cv::RNG rng(4);
  rng.fill(image, cv::RNG::UNIFORM, 0.0f, 255.0f);
  cv::Mat1f patch(20, 30), valid(20, 30);
  EXPECT_TRUE(warpBilinear(image, Eigen::Matrix3d::Identity(), patch, valid));
  EXPECT_LE(cv::norm(patch, image, cv::NORM_INF), 3e-5);  // the last column is reached by rounding: 255 * 2^-23
  EXPECT_EQ(cv::norm(patch(cv::Rect(0, 0, 29, 19)), image(cv::Rect(0, 0, 29, 19)), cv::NORM_INF), 0.0);
}

TEST(WarpBilinear, MarksExactlyWhatLiesBetweenThePixelCentres) {
  const cv::Mat1f image = bilinearImage(30, 20);
  Eigen::Matrix3d g = Eigen::Matrix3d::Identity();
  g(0, 2) = -2.5;
  g(1, 2) = 1.0;
  cv::Mat1f patch(20, 30), valid(20, 30);
  EXPECT_FALSE(warpBilinear(image, g, patch, valid));
  for (int j = 0; j < 20; ++j) {
    for (int i = 0; i < 30; ++i) EXPECT_EQ(valid(j, i), i >= 3 && j <= 18 ? 1.0f : 0.0f) << i << ", " << j;
  }
}

TEST(WarpBilinear, ReadsNothingOutsideForAnyHomography) {
  cv::Mat1f image(7, 9, 100.0f);
  cv::Mat1f patch(11, 13), valid(11, 13);
  cv::RNG rng(2);
  for (int k = 0; k < 2000; ++k) {
    Eigen::Matrix3d g;
    for (int e = 0; e < 9; ++e) g(e / 3, e % 3) = rng.gaussian(e < 6 ? 10.0 : 0.3);
    if (k % 10 == 0) g(2, 2) = std::nan("");
    if (k % 11 == 0) g(0, 0) = 1e30;
    warpBilinear(image, g, patch, valid);
    for (int j = 0; j < patch.rows; ++j) {
      for (int i = 0; i < patch.cols; ++i) {
        ASSERT_EQ(patch(j, i), 100.0f);
        ASSERT_TRUE(valid(j, i) == 0.0f || valid(j, i) == 1.0f);
      }
    }
  }
}

TEST(WarpBilinear, TakesAnImageOfOnePixel) {
  const cv::Mat1f image(1, 1, 42.0f);
  cv::Mat1f patch(2, 2), valid(2, 2);
  EXPECT_FALSE(warpBilinear(image, Eigen::Matrix3d::Identity(), patch, valid));
  EXPECT_EQ(patch(0, 0), 42.0f);
  EXPECT_EQ(valid(0, 0), 1.0f);
  EXPECT_EQ(valid(1, 1), 0.0f);
}

TEST(WarpBilinear, GivesTheSameWithAndWithoutAMargin) {
  const cv::Mat1f image = bilinearImage(80, 60);
  Eigen::Matrix3d g;
  g << 0.9, 0.05, 12.3, -0.04, 1.1, -2.7, 0.0005, -0.0003, 1.0;
  Patch patch, valid;
  patch.resize(300, 40);  // more than one chunk of a row
  valid.resize(300, 40);
  cv::Mat1f plain(40, 300), plain_valid(40, 300);
  EXPECT_FALSE(warpBilinear(image, g, patch, valid));
  EXPECT_FALSE(warpBilinear(image, g, plain, plain_valid));
  EXPECT_EQ(cv::norm(patch.view(), plain, cv::NORM_INF), 0.0);
  EXPECT_EQ(cv::norm(valid.view(), plain_valid, cv::NORM_INF), 0.0);
}

}  // namespace
}  // namespace laparoscope_servo::image
