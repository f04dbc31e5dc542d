#include "features/shafts/grey_lines.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace laparoscope_servo::features {
namespace {

const cv::Scalar kTissue(60, 70, 170), kSteel(150, 145, 135);  // blue, green, red
constexpr double kThreshold = GreyMap::kZero + 0.4 * GreyMap::kUnit;

// A map with a pixel a cell: steel where the mask is set.
struct Scene {
  explicit Scene(const cv::Mat1b& steel) {
    cv::Mat image(steel.size(), CV_8UC3, kTissue);
    image.setTo(kSteel, steel);
    map.compute(image);
    view.compute(map.level());
  }
  const std::vector<GreyLine>& find() { return lines.find(map, view, kThreshold); }

  GreyMap map;
  image::FieldOfView view;
  GreyLines lines;
};

cv::Mat1b nothing() {
  return cv::Mat1b::zeros(150, 200);
}

// Steel within `half` of the straight line through (100, 75) with this normal.
cv::Mat1b band(double angle, double half) {
  cv::Mat1b mask = nothing();
  for (int v = 0; v < mask.rows; ++v) {
    for (int u = 0; u < mask.cols; ++u) {
      if (std::abs((u - 100) * std::cos(angle) + (v - 75) * std::sin(angle)) < half) mask(v, u) = 255;
    }
  }
  return mask;
}

TEST(GreyLines, ThereIsNoneWhereNothingIsGreyOrAllIs) {
  EXPECT_TRUE(Scene(nothing()).find().empty());
  EXPECT_TRUE(Scene(cv::Mat1b(150, 200, 255)).find().empty());
}

// Both edges of a band, whose normals point away from it, at every angle.
TEST(GreyLines, FindsBothEdgesOfABandAtEveryAngle) {
  for (const double angle : {0.0, 0.3, M_PI / 4.0, 1.3, M_PI / 2.0, 2.5}) {
    Scene scene(band(angle, 12.0));
    const std::vector<GreyLine>& lines = scene.find();
    ASSERT_GE(lines.size(), 2u) << angle;
    const Eigen::Vector2d normal(std::cos(angle), std::sin(angle)), middle(100.0, 75.0);
    int sides[2] = {0, 0};
    for (const GreyLine& line : {lines[0], lines[1]}) {
      const double side = line.normal.dot(normal);
      EXPECT_GT(std::abs(side), std::cos(0.02)) << angle;
      ++sides[side > 0.0 ? 0 : 1];
      EXPECT_NEAR(line.distance(middle), -12.0, 0.8) << angle << ": what is grey lies behind the line";
      EXPECT_GT(line.length(), 100.0) << angle;
      EXPECT_GT(line.support, 90) << angle;
      // (170 - 65) / 100 of the tissue, and -(147.5 - 135) / 143 of the steel.
      EXPECT_NEAR(line.contrast, 1.05 + 0.087, 0.25) << angle;
    }
    EXPECT_EQ(sides[0], 1) << angle;
    EXPECT_EQ(sides[1], 1) << angle;
  }
}

TEST(GreyLines, TheDirectionIsTheNormalTurned) {
  Scene scene(band(0.3, 12.0));
  for (const GreyLine& line : scene.find()) {
    EXPECT_NEAR(line.normal.norm(), 1.0, 1e-9);
    EXPECT_NEAR(line.direction().dot(line.normal), 0.0, 1e-12);
    EXPECT_NEAR(line.normal.x() * line.direction().y() - line.normal.y() * line.direction().x(), 1.0, 1e-9);
    EXPECT_NEAR(line.distance(line.at(17.0)), 0.0, 1e-9);
    EXPECT_LT(line.begin, line.end);
  }
}

// The strongest first; a point of the outline belongs to one line only.
TEST(GreyLines, ThePiecesOfARectangleAreFourInOrder) {
  cv::Mat1b mask = nothing();
  mask(cv::Rect(30, 40, 120, 50)).setTo(255);
  Scene scene(mask);
  const std::vector<GreyLine>& lines = scene.find();
  ASSERT_EQ(lines.size(), 4u);
  double all = 0.0;
  for (const GreyLine& line : lines) all += line.support;
  EXPECT_LE(all, 2.0 * (120.0 + 50.0) + 8.0) << "as many points as the outline has";
  EXPECT_GT(lines[1].support, lines[2].support) << "the long sides";
  EXPECT_NEAR(lines[0].length(), 119.0, 4.0);
  EXPECT_NEAR(lines[3].length(), 49.0, 4.0);
}

// A gap of one cell takes three points away, whose normals turn towards it: that is one line, a wider gap parts it.
TEST(GreyLines, ALineEndsAtAGap) {
  for (const int gap : {1, 20}) {
    cv::Mat1b mask = band(M_PI / 2.0, 10.0);
    mask(cv::Rect(100, 0, gap, 150)).setTo(0);
    Scene scene(mask);
    double longest = 0.0;
    for (const GreyLine& line : scene.find()) longest = std::max(longest, line.length());
    EXPECT_EQ(longest > 150.0, gap == 1) << gap << ": " << longest;
  }
}

// The picture's border is none of an instrument, though black lies beyond it.
TEST(GreyLines, TheBordersOfThePictureAreNone) {
  cv::Mat1b mask = nothing();
  mask(cv::Rect(0, 0, 60, 150)).setTo(255);
  Scene left(mask);
  const std::vector<GreyLine>& lines = left.find();
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_GT(lines[0].normal.x(), 0.99);
  EXPECT_NEAR(lines[0].at(0.0).x(), 59.5, 0.7);
  cv::Mat image(150, 200, CV_8UC3, kTissue), round = cv::Mat::zeros(150, 200, CV_8UC3);
  cv::Mat1b circle = nothing();
  cv::circle(circle, {100, 75}, 70, 255, cv::FILLED);
  image.copyTo(round, circle);
  GreyMap map;
  map.compute(round);
  image::FieldOfView view;
  view.compute(map.level());
  EXPECT_TRUE(GreyLines().find(map, view, kThreshold).empty());
}

// A picture leaves nothing for the next one.
TEST(GreyLines, FindsAnewInEachPicture) {
  Scene scene(band(0.3, 12.0));
  const std::size_t count = scene.find().size();
  const double first = scene.lines.find(scene.map, scene.view, kThreshold)[0].begin;
  Scene other(nothing());
  EXPECT_TRUE(scene.lines.find(other.map, other.view, kThreshold).empty());
  const std::vector<GreyLine>& again = scene.find();
  EXPECT_EQ(again.size(), count);
  EXPECT_EQ(again[0].begin, first);
}

}  // namespace
}  // namespace laparoscope_servo::features
