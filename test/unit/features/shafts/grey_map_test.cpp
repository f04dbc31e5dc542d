#include "features/shafts/grey_map.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace laparoscope_servo::features {
namespace {

int colourOf(const cv::Scalar& bgr) {
  GreyMap map;
  map.compute(cv::Mat(240, 320, CV_8UC3, bgr));
  return map.colour()(map.rows() / 2, map.columns() / 2);
}

TEST(GreyMap, greyIsZeroRedIsMoreBlueIsLessAndBrightnessDoesNotMatter) {
  for (const double level : {40.0, 120.0, 240.0}) EXPECT_NEAR(colourOf({level, level, level}), GreyMap::kZero, 3.0);
  EXPECT_GT(colourOf({60, 60, 180}), GreyMap::kZero + 0.5 * GreyMap::kUnit);
  EXPECT_LT(colourOf({180, 60, 60}), GreyMap::kZero);
  EXPECT_NEAR(colourOf({40, 50, 110}), colourOf({80, 100, 220}), 3.0);
}

// Chroma of what is nearly black cannot be told: it is no instrument.
TEST(GreyMap, blackIsNotGrey) {
  EXPECT_EQ(colourOf({5, 5, 5}), 255);
}

TEST(GreyMap, cellsOfAnySizeOfImageAreAboutAsMany) {
  for (const int columns : {64, 320, 640, 1920, 3840}) {
    GreyMap map;
    map.compute(cv::Mat(columns / 2, columns, CV_8UC3, cv::Scalar(90, 90, 90)));
    EXPECT_EQ(map.columns(), columns / map.step()) << columns;
    EXPECT_GT(map.columns(), std::min(columns - 1, 130)) << columns;
    EXPECT_LT(map.columns(), 330) << columns;
    for (const double cell : {0.0, 3.25, 17.0}) EXPECT_NEAR(map.toCell(map.toPixel(cell)), cell, 1e-12);
    // Its first cell takes in the first `step` pixels.
    EXPECT_DOUBLE_EQ(map.toPixel(0.0), 0.5 * (map.step() - 1));
  }
}

TEST(GreyMap, aPointThatIsNowhereIsInNoCell) {
  GreyMap map;
  map.compute(cv::Mat(240, 320, CV_8UC3, cv::Scalar(90, 90, 90)));
  EXPECT_EQ(GreyMap::cellOf({3.4, 6.6}), cv::Point(3, 7));
  EXPECT_EQ(GreyMap::cellOf({-3.4, -0.4}), cv::Point(-3, 0));
  for (const double wrong : {std::nan(""), std::numeric_limits<double>::infinity(), 1e10, -1e200}) {
    for (const Eigen::Vector2d& p : {Eigen::Vector2d(wrong, 5.0), Eigen::Vector2d(5.0, wrong)}) {
      const cv::Point cell = GreyMap::cellOf(p);
      EXPECT_FALSE(map.contains(cell.x, cell.y)) << p.transpose();
    }
  }
}

}  // namespace
}  // namespace laparoscope_servo::features
