#include "features/shafts/mask_drawing.h"

#include <gtest/gtest.h>

#include <limits>
#include <opencv2/imgproc.hpp>

namespace laparoscope_servo::features {
namespace {

using Corners = std::array<Eigen::Vector2d, 4>;

cv::Mat1b filled(const Corners& corners, const cv::Size& size, cv::Rect* box = nullptr) {
  cv::Mat1b mask = cv::Mat1b::zeros(size);
  const cv::Rect drawn = drawQuadrangle(corners, mask);
  if (box != nullptr) *box = drawn;
  return mask;
}

TEST(DrawQuadrangle, FillsARectangleToItsPixels) {
  cv::Rect box;
  const cv::Mat1b mask = filled({{{3, 2}, {7, 2}, {7, 5}, {3, 5}}}, {12, 10}, &box);
  EXPECT_EQ(box, cv::Rect(3, 2, 5, 4));
  EXPECT_EQ(cv::countNonZero(mask), 20);
  EXPECT_EQ(cv::countNonZero(mask(box)), 20);
}

// As OpenCV, but for pixels of the outline.
TEST(DrawQuadrangle, IsWhatOpenCvFillsButForTheOutline) {
  cv::RNG random(5);
  const cv::Size size(80, 60);
  for (int k = 0; k < 200; ++k) {
    // Convex: the corners lie on an ellipse, in order, also beyond the border.
    const Eigen::Vector2d middle(random.uniform(-10.0, 90.0), random.uniform(-10.0, 70.0));
    const double a = random.uniform(3.0, 120.0), b = random.uniform(3.0, 60.0), begin = random.uniform(0.0, 6.28);
    Corners corners;
    std::array<cv::Point, 4> rounded;
    for (std::size_t i = 0; i < 4; ++i) {
      const double angle = begin + 1.5 * static_cast<double>(i) + random.uniform(0.0, 0.3);
      corners[i] = middle + Eigen::Vector2d(a * std::cos(angle), b * std::sin(angle));
      rounded[i] = {cvRound(corners[i].x()), cvRound(corners[i].y())};
    }
    cv::Rect box;
    const cv::Mat1b mask = filled(corners, size, &box);
    cv::Mat1b other = cv::Mat1b::zeros(size), outline = cv::Mat1b::zeros(size);
    cv::fillConvexPoly(other, rounded.data(), 4, 255);
    for (std::size_t i = 0; i < 4; ++i) cv::line(outline, rounded[i], rounded[(i + 1) % 4], 255, 3);
    cv::Mat1b differs;
    cv::bitwise_xor(mask, other, differs);
    EXPECT_EQ(cv::countNonZero(differs & ~outline), 0) << k;
    EXPECT_EQ(box.empty() ? 0 : cv::countNonZero(mask(box)), cv::countNonZero(mask)) << k;
  }
}

TEST(DrawQuadrangle, DrawsNothingOfWhatLiesOutsideOrIsNotFinite) {
  const double nothing = std::numeric_limits<double>::quiet_NaN(), far = std::numeric_limits<double>::infinity();
  for (const Corners& corners :
       {Corners{{{-9, 2}, {-5, 2}, {-5, 5}, {-9, 5}}}, Corners{{{3, 20}, {7, 20}, {7, 25}, {3, 25}}},
        Corners{{{3, 2}, {7, nothing}, {7, 5}, {3, 5}}}, Corners{{{3, 2}, {far, 2}, {7, 5}, {3, 5}}}}) {
    cv::Rect box;
    EXPECT_EQ(cv::countNonZero(filled(corners, {12, 10}, &box)), 0);
    EXPECT_TRUE(box.empty());
  }
}

TEST(MaskGrowth, GrowsAsOpenCvByADisc) {
  cv::RNG random(3);
  MaskGrowth growth;
  for (int k = 0; k < 60; ++k) {
    const cv::Size size(random.uniform(20, 90), random.uniform(20, 70));
    cv::Mat1b mask = cv::Mat1b::zeros(size);
    const cv::Rect box(random.uniform(0, 10), random.uniform(0, 10), random.uniform(1, 10), random.uniform(1, 10));
    cv::Mat1b part = mask(box);
    random.fill(part, cv::RNG::UNIFORM, 0, 2);
    const int radius = random.uniform(0, 15);
    cv::Mat1b target = cv::Mat1b::zeros(size), expected;
    target(size.height - 1, size.width - 1) = 255;
    growth.add(mask, box, radius, target);
    cv::dilate(mask * 255, expected, cv::getStructuringElement(cv::MORPH_ELLIPSE, {2 * radius + 1, 2 * radius + 1}));
    expected(size.height - 1, size.width - 1) = 255;
    EXPECT_EQ(cv::countNonZero(target != expected), 0) << size << ' ' << box << ' ' << radius;
  }
}

TEST(MaskGrowth, OfAnEmptyBoxIsNothing) {
  cv::Mat1b mask = cv::Mat1b::ones({8, 8}), target = cv::Mat1b::zeros(8, 8);
  MaskGrowth growth;
  growth.add(mask, cv::Rect(), 3, target);
  EXPECT_EQ(cv::countNonZero(target), 0);
}

}  // namespace
}  // namespace laparoscope_servo::features
