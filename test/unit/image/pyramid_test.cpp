#include "laparoscope_servo/image/pyramid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>
#include <stdexcept>

#include "support/synthetic_tissue.h"

namespace laparoscope_servo::image {
namespace {

// A plane of grey levels is its own low-pass: every level must show it where the header says.
TEST(RegionPyramid, LevelsShowAPlaneOfGreyLevelsAtTheirCoordinates) {
  cv::Mat image(120, 160, CV_8UC1);
  for (int v = 0; v < image.rows; ++v) {
    for (int u = 0; u < image.cols; ++u) image.at<unsigned char>(v, u) = static_cast<unsigned char>(u + v / 2);
  }
  RegionPyramid pyramid;
  pyramid.build(image, cv::Rect(21, 13, 90, 80), 3, kLuma);
  ASSERT_EQ(pyramid.levels(), 3);
  EXPECT_EQ(pyramid.origin(), cv::Point(21, 13));
  for (int l = 0; l < 3; ++l) {
    const cv::Mat1f& level = pyramid.level(l);
    for (int v = 2; v + 2 < level.rows; ++v) {
      for (int u = 2; u + 2 < level.cols; ++u) {
        const double expected = (21 + u * (1 << l)) + 0.5 * (13 + v * (1 << l));
        EXPECT_NEAR(level(v, u), expected, 0.5) << "level " << l << " at " << u << ", " << v;
      }
    }
  }
}

TEST(RegionPyramid, ACoarserFinestLevelIsTheLevelOfThatScale) {
  const cv::Mat image = test::tissue(cv::Size(150, 130), 4);
  const cv::Rect region(11, 7, 120, 101);
  RegionPyramid from_image, from_scale;
  from_image.build(image, region, 5, kLuma);
  for (const int scale : {2, 4}) {
    from_scale.build(image, region, 2, kLuma, scale);
    for (int l = 0; l < 2; ++l) {
      const int same = l + (scale == 2 ? 1 : 2);
      EXPECT_EQ(from_scale.scale(l), from_image.scale(same));
      ASSERT_EQ(from_scale.level(l).size(), from_image.level(same).size());
      EXPECT_EQ(cv::norm(from_scale.level(l), from_image.level(same), cv::NORM_INF), 0.0);
      EXPECT_EQ(from_scale.levelFromImage(l), from_image.levelFromImage(same));
    }
  }
}

TEST(RegionPyramid, WeighsTheChannels) {
  const cv::Mat image(30, 30, CV_8UC3, cv::Scalar(10, 20, 30));
  RegionPyramid pyramid;
  pyramid.build(image, cv::Rect(0, 0, 30, 30), 1, ChannelWeights{0.5f, -0.25f, 1.0f});
  EXPECT_FLOAT_EQ(pyramid.level(0)(7, 3), 0.5f * 10 - 0.25f * 20 + 30);
}

TEST(RegionPyramid, TakesColumnsAndRowsFromAViewWithPadding) {
  const cv::Mat whole = test::tissue(cv::Size(100, 80), 3);
  const cv::Mat part = whole(cv::Rect(10, 10, 50, 40));
  RegionPyramid of_view, of_copy;
  of_view.build(part, cv::Rect(5, 5, 30, 30), 2, kLuma);
  of_copy.build(part.clone(), cv::Rect(5, 5, 30, 30), 2, kLuma);
  for (int l = 0; l < 2; ++l) EXPECT_EQ(cv::norm(of_view.level(l), of_copy.level(l), cv::NORM_INF), 0.0);
}

TEST(RegionPyramid, CutsTheRegionToTheImage) {
  const cv::Mat image(30, 40, CV_8UC1, cv::Scalar(7));
  RegionPyramid pyramid;
  pyramid.build(image, cv::Rect(-10, -10, 100, 100), 2, kLuma);
  EXPECT_EQ(pyramid.region(), cv::Rect(0, 0, 40, 30));
  EXPECT_EQ(pyramid.level(1).size(), cv::Size(20, 15));
}

TEST(RegionPyramid, RefusesWhatItCannotBuild) {
  RegionPyramid pyramid;
  const cv::Mat image(30, 40, CV_8UC1, cv::Scalar(7));
  EXPECT_THROW(pyramid.build(image, cv::Rect(50, 0, 10, 10), 2, kLuma), std::invalid_argument);
  EXPECT_THROW(pyramid.build(image, cv::Rect(0, 0, 10, 10), 0, kLuma), std::invalid_argument);
  EXPECT_THROW(pyramid.build(cv::Mat(30, 40, CV_32FC1), cv::Rect(0, 0, 10, 10), 1, kLuma), std::invalid_argument);
}

TEST(RegionPyramid, LeavesOfNoiseWhatItSaysItLeaves) {
  cv::Mat1b noise(400, 400);
  cv::RNG(5).fill(noise, cv::RNG::NORMAL, 128.0, 10.0);
  RegionPyramid pyramid;
  pyramid.build(noise, cv::Rect(0, 0, 400, 400), 3, kLuma);
  for (int l = 0; l < 3; ++l) {
    const LevelNoise left = levelNoise(pyramid.scale(l));
    const cv::Mat1f level = pyramid.level(l);
    cv::Scalar mean, deviation;
    cv::meanStdDev(level, mean, deviation);
    EXPECT_NEAR(deviation[0] / (10.0 * left.deviation), 1.0, 0.05) << l;
    double square = 0.0;
    for (int j = 1; j + 1 < level.rows; ++j) {
      for (int i = 1; i + 1 < level.cols; ++i)
        square += std::pow(0.5 * (level(j, i + 1) - level(j, i - 1)), 2) +
                  std::pow(0.5 * (level(j + 1, i) - level(j - 1, i)), 2);
    }
    square /= (level.rows - 2.0) * (level.cols - 2.0);
    EXPECT_NEAR(square / (100.0 * left.gradient), 1.0, 0.08) << l;
  }
}

}  // namespace
}  // namespace laparoscope_servo::image
