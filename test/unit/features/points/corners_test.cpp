#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

#include "laparoscope_servo/features/points.h"
#include "support/synthetic_tissue.h"

namespace laparoscope_servo::features {
namespace {

TEST(Corners, LieInTheRegionApartAndNoMoreThanAskedFor) {
  const cv::Mat image = test::tissue({320, 240}, 3);
  const cv::Rect region(60, 50, 150, 120);
  const auto corners = findCorners(image, region, 25, {});
  EXPECT_GE(corners.size(), 15u);
  EXPECT_LE(corners.size(), 25u);
  for (std::size_t k = 0; k < corners.size(); ++k) {
    EXPECT_TRUE(region.contains(cv::Point(static_cast<int>(corners[k].x()), static_cast<int>(corners[k].y()))));
    for (std::size_t l = 0; l < k; ++l) EXPECT_GE((corners[k] - corners[l]).norm(), 11.9);
  }
  EXPECT_GT(findCorners(image, {}, 200, {}).size(), 60u);
}

TEST(Corners, KeepAwayFromHighlightsTheBlackBorderAndTheImagesOwn) {
  cv::Mat image = test::tissue({320, 240}, 3);
  cv::circle(image, {100, 100}, 6, cv::Scalar::all(255), -1);
  cv::Mat1b outside(image.size(), static_cast<uchar>(255));
  cv::circle(outside, {160, 120}, 115, cv::Scalar(0), -1);
  image.setTo(cv::Scalar::all(0), outside);
  PointsConfig config;
  const auto corners = findCorners(image, {}, 100, config);
  EXPECT_GE(corners.size(), 20u);
  const double half = config.window / 2;
  for (const Eigen::Vector2d& corner : corners) {
    EXPECT_GT((corner - Eigen::Vector2d(100.0, 100.0)).lpNorm<Eigen::Infinity>(), half + 6.0);
    EXPECT_LT((corner - Eigen::Vector2d(160.0, 120.0)).norm(), 115.0 - half);
  }
}

TEST(Corners, ThereAreNoneWhereThereIsNoTextureOrOnlyAnEdge) {
  EXPECT_TRUE(findCorners(cv::Mat(240, 320, CV_8UC1, cv::Scalar(90)), {}, 30, {}).empty());
  cv::Mat edge(240, 320, CV_8UC1, cv::Scalar(80));
  edge.colRange(150, 320).setTo(160);
  cv::GaussianBlur(edge, edge, cv::Size(), 1.0);
  EXPECT_TRUE(findCorners(edge, {}, 30, {}).empty());
  EXPECT_TRUE(findCorners(test::tissue({320, 240}, 3), {500, 500, 20, 20}, 30, {}).empty());
}

}  // namespace
}  // namespace laparoscope_servo::features
