#include "tracking/selection/proposal.h"

#include <gtest/gtest.h>

#include "support/synthetic_tissue.h"

namespace laparoscope_servo::tracking {
namespace {

const cv::Size kSize(320, 240);
const cv::Mat kClear;  // nothing covers the tissue

// Smooth, but for what lies in `textured`.
cv::Mat smoothBut(const cv::Rect& textured) {
  cv::Mat image(kSize, CV_8UC3, cv::Scalar(70, 80, 150));
  test::tissue(kSize, 5)(textured).copyTo(image(textured));
  return image;
}

cv::Rect box(const geometry::Rectangle& roi) {
  return {static_cast<int>(roi.x), static_cast<int>(roi.y), static_cast<int>(roi.width), static_cast<int>(roi.height)};
}

bool any(const geometry::Rectangle&) {
  return true;
}

TEST(ProposeRegion, LiesWhereTheTextureIs) {
  const cv::Rect textured(150, 60, 90, 90);
  const auto found = proposeRegion(smoothBut(textured), kClear, {80, 80, 60, 60}, nullptr, any);
  ASSERT_TRUE(found);
  EXPECT_GT((box(*found) & textured).area(), 0);
}

TEST(ProposeRegion, IsTheNearestOneThatWouldDo) {
  const cv::Mat image = smoothBut({0, 0, 320, 240});
  const geometry::Rectangle wanted = {130, 90, 60, 60};
  const auto would_do = [&](const geometry::Rectangle& roi) { return roi.width > wanted.width; };
  const auto found = proposeRegion(image, kClear, wanted, nullptr, would_do);
  ASSERT_TRUE(found);
  EXPECT_GT(found->width, wanted.width);
  // The texture is to the right, near and far: the near one is meant.
  cv::Mat two = smoothBut({150, 60, 60, 60});
  test::tissue(kSize, 9)(cv::Rect(250, 60, 60, 60)).copyTo(two(cv::Rect(250, 60, 60, 60)));
  const auto near = proposeRegion(two, kClear, {80, 60, 60, 60}, nullptr, any);
  ASSERT_TRUE(near);
  EXPECT_LT(near->x, 150.0);
}

TEST(ProposeRegion, AsksOnlyForWholePixelsInsideTheImage) {
  const cv::Mat image = smoothBut({0, 0, 320, 240});
  int asked = 0;
  const auto none = proposeRegion(image, kClear, {3.5, 2.5, 70.3, 50.7}, nullptr, [&](const geometry::Rectangle& roi) {
    ++asked;
    EXPECT_EQ(roi.x, std::floor(roi.x));
    EXPECT_EQ(roi.width, std::floor(roi.width));
    EXPECT_EQ(box(roi) & cv::Rect(cv::Point(0, 0), kSize), box(roi));
    return false;
  });
  EXPECT_FALSE(none);
  EXPECT_LE(asked, 5);
}

TEST(ProposeRegion, IsNoneInASmoothImageAndInOneThatIsTooSmall) {
  EXPECT_FALSE(proposeRegion(cv::Mat(kSize, CV_8UC3, cv::Scalar(70, 80, 150)), kClear, {80, 80, 60, 60}, nullptr, any));
  EXPECT_FALSE(proposeRegion(test::tissue({40, 40}, 5), kClear, {0, 0, 60, 60}, nullptr, any));
}

TEST(ProposeRegion, OfARegionOutsideTheImageIsInsideIt) {
  const auto found = proposeRegion(smoothBut({0, 0, 320, 240}), kClear, {-40, 100, 60, 60}, nullptr, any);
  ASSERT_TRUE(found);
  EXPECT_GE(found->x, 0.0);
}

// The nearest texture is covered: the region lies beside it.
TEST(ProposeRegion, LiesBesideWhatIsCovered) {
  const cv::Mat image = smoothBut({0, 0, 320, 240});
  const geometry::Rectangle wanted = {130, 90, 60, 60};
  cv::Mat covered = cv::Mat::zeros(kSize, CV_8UC1);
  covered(cv::Rect(100, 0, 80, 240)).setTo(255);
  const auto found = proposeRegion(image, covered, wanted, nullptr, any);
  ASSERT_TRUE(found);
  EXPECT_LT(cv::countNonZero(covered(box(*found))), 0.06 * found->width * found->height);
  covered.setTo(1);
  EXPECT_FALSE(proposeRegion(image, covered, wanted, nullptr, any));
}

TEST(ProposeRegion, IgnoresTextureThatIsAHighlight) {
  cv::Mat image(kSize, CV_8UC3, cv::Scalar(70, 80, 150));
  for (int k = 0; k < 8; ++k) image(cv::Rect(150 + 8 * k, 60, 4, 70)).setTo(cv::Scalar(255, 255, 255));
  const auto found = proposeRegion(image, kClear, {80, 70, 50, 50}, nullptr, any);
  EXPECT_FALSE(found);
}

// Through the lens, regions are in rectified pixels: what lies beyond the raw image's own width may be proposed.
TEST(ProposeRegion, WithALensIsInRectifiedPixels) {
  image::LensParameters parameters;
  parameters.coefficients = {-0.3};
  parameters.raw.fx = parameters.raw.fy = 240.0;
  parameters.raw.cx = 159.5;
  parameters.raw.cy = 119.5;
  parameters.rectified = parameters.raw;
  const image::Lens lens(parameters);
  const cv::Rect textured(20, 90, 60, 60);  // of the raw image
  const auto found = proposeRegion(smoothBut(textured), kClear, {60, 90, 50, 50}, &lens, any);
  ASSERT_TRUE(found);
  const cv::Rect seen = image::seenBox(&lens, found->corners(), 0.0);
  EXPECT_GT((seen & textured).area(), 0);
}

}  // namespace
}  // namespace laparoscope_servo::tracking
