#include "laparoscope_servo/image/colour_patch.h"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <stdexcept>
#include <vector>

#include "support/synthetic_tissue.h"

namespace laparoscope_servo::image {
namespace {

Eigen::Matrix3d shift(double x, double y) {
  Eigen::Matrix3d g = Eigen::Matrix3d::Identity();
  g.topRightCorner<2, 1>() << x, y;
  return g;
}

bool equal(const cv::Mat& a, const cv::Mat& b) {
  return a.type() == b.type() && cv::norm(a, b, cv::NORM_INF) == 0.0;
}

ColourPatch warped(const cv::Mat& image, const Eigen::Matrix3d& g, const cv::Size& size) {
  ColourPatch patch;
  warpNearest(image, g, size, patch);
  return patch;
}

cv::Mat interleaved(const ColourPatch& patch) {
  cv::Mat image;
  cv::merge(std::vector<cv::Mat>{patch.blue, patch.green, patch.red}, image);
  return image;
}

TEST(WarpNearest, CutsTheRegionThatAnIntegerShiftNames) {
  const cv::Mat image = test::tissue(cv::Size(400, 50), 1);
  for (const double fraction : {0.0, 0.4, -0.4}) {  // rounds to the same pixels
    const ColourPatch patch = warped(image, shift(7 + fraction, 5 + fraction), cv::Size(300, 30));
    EXPECT_TRUE(patch.has_colour);
    EXPECT_TRUE(equal(interleaved(patch), image(cv::Rect(7, 5, 300, 30)).clone())) << fraction;
    EXPECT_EQ(cv::countNonZero(patch.valid), 300 * 30);
  }
}

TEST(WarpNearest, ReadsViewsWithPadding) {
  const cv::Mat whole = test::tissue(cv::Size(100, 80), 1);
  const cv::Mat part = whole(cv::Rect(13, 7, 60, 50));
  EXPECT_TRUE(equal(interleaved(warped(part, shift(2, 3), cv::Size(20, 30))), whole(cv::Rect(15, 10, 20, 30)).clone()));
}

TEST(WarpNearest, MarksWhatLiesOutsideTheImage) {
  const cv::Mat image(50, 60, CV_8UC1, cv::Scalar(9));
  ColourPatch patch = warped(image, shift(-3, -2), cv::Size(60, 50));
  EXPECT_FALSE(patch.has_colour);
  EXPECT_EQ(cv::countNonZero(patch.valid), 57 * 48);
  EXPECT_EQ(patch.valid(1, 10), 0);
  EXPECT_EQ(patch.valid(10, 2), 0);
  EXPECT_EQ(patch.valid(2, 3), 255);
  EXPECT_EQ(patch.blue(1, 1), 0);
  EXPECT_EQ(patch.blue(2, 3), 9);
  patch = warped(image, shift(1000, 1000), cv::Size(10, 10));
  EXPECT_EQ(cv::countNonZero(patch.valid), 0);
}

TEST(WarpNearest, NothingIsValidBehindTheCamera) {
  const cv::Mat image(50, 60, CV_8UC1, cv::Scalar(9));
  EXPECT_EQ(cv::countNonZero(warped(image, -Eigen::Matrix3d::Identity(), cv::Size(10, 10)).valid), 0);
  EXPECT_EQ(cv::countNonZero(warped(image, Eigen::Matrix3d::Constant(std::nan("")), cv::Size(10, 10)).valid), 0);
}

TEST(WarpNearest, RefusesOtherTypes) {
  EXPECT_THROW(warped(cv::Mat(5, 5, CV_16UC1), shift(0, 0), cv::Size(2, 2)), std::invalid_argument);
}

TEST(SaturatedPixels, AnyChannelCountsAndTheMaskGrows) {
  cv::Mat image(20, 20, CV_8UC3, cv::Scalar(10, 20, 30));
  image.at<cv::Vec3b>(10, 10) = {0, 250, 0};
  image.at<cv::Vec3b>(0, 0) = {249, 249, 249};
  const ColourPatch patch = warped(image, shift(0, 0), image.size());
  cv::Mat1b mask;
  saturatedPixels(patch, 250, 0, mask);
  EXPECT_EQ(cv::countNonZero(mask), 1);
  EXPECT_EQ(mask(10, 10), 255);
  saturatedPixels(patch, 250, 2, mask);
  EXPECT_EQ(cv::countNonZero(mask), 25);
  EXPECT_EQ(mask(8, 12), 255);
  EXPECT_EQ(mask(7, 10), 0);
  saturatedPixels(patch, 256, 2, mask);
  EXPECT_EQ(cv::countNonZero(mask), 0);
}

// OpenCV's dilation is another implementation of the same. Narrower than the growth, and wider than the chunks of a
// row.
TEST(SaturatedPixels, GrowAsADilationWithASquare) {
  cv::RNG rng(5);
  for (const cv::Size& size : {cv::Size(1, 1), cv::Size(3, 40), cv::Size(40, 2), cv::Size(700, 50)}) {
    for (const int grow : {0, 1, 2, 5, 64}) {
      cv::Mat1b image(size);
      rng.fill(image, cv::RNG::UNIFORM, 0, 255);
      image.setTo(0, image < 252);
      cv::Mat1b mask, expected = image >= 253;
      if (grow > 0) cv::dilate(expected, expected, cv::Mat1b::ones(2 * grow + 1, 2 * grow + 1));
      saturatedPixels(warped(image, shift(0, 0), size), 253, grow, mask);
      EXPECT_EQ(cv::norm(mask, expected, cv::NORM_INF), 0.0) << size << " by " << grow;
    }
  }
}

TEST(SaturatedPixels, RefuseAGrowthOutOfRange) {
  const ColourPatch patch = warped(cv::Mat(5, 5, CV_8UC1, cv::Scalar(1)), shift(0, 0), cv::Size(5, 5));
  cv::Mat1b mask;
  EXPECT_THROW(saturatedPixels(patch, 250, -1, mask), std::invalid_argument);
  EXPECT_THROW(saturatedPixels(patch, 250, 65, mask), std::invalid_argument);
}

TEST(SaturatedPixels, TakesGreyImages) {
  const cv::Mat image(5, 5, CV_8UC1, cv::Scalar(251));
  cv::Mat1b mask;
  saturatedPixels(warped(image, shift(0, 0), image.size()), 250, 2, mask);
  EXPECT_EQ(cv::countNonZero(mask), 25);
}

}  // namespace
}  // namespace laparoscope_servo::image
