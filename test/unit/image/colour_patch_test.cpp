#include "laparoscope_servo/image/colour_patch.h"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <stdexcept>

#include "../../support/synthetic_tissue.h"

namespace laparoscope_servo::image {
namespace {

Eigen::Matrix3d shift(double x, double y) {
  Eigen::Matrix3d g = Eigen::Matrix3d::Identity();
  g.topRightCorner<2, 1>() << x, y;
  return g;
}

bool equal(const cv::Mat& a, const cv::Mat& b) { return a.type() == b.type() && cv::norm(a, b, cv::NORM_INF) == 0.0; }

TEST(WarpNearest, CutsTheRegionThatAnIntegerShiftNames) {
  const cv::Mat image = test::tissue(cv::Size(60, 50), 1);
  cv::Mat patch;
  cv::Mat1b valid;
  for (const double fraction : {0.0, 0.4, -0.4}) {  // rounds to the same pixels
    warpNearest(image, shift(7 + fraction, 5 + fraction), cv::Size(20, 30), patch, valid);
    EXPECT_TRUE(equal(patch, image(cv::Rect(7, 5, 20, 30)).clone())) << fraction;
    EXPECT_EQ(cv::countNonZero(valid), 20 * 30);
  }
}

TEST(WarpNearest, MarksWhatLiesOutsideTheImage) {
  const cv::Mat image(50, 60, CV_8UC1, cv::Scalar(9));
  cv::Mat patch;
  cv::Mat1b valid;
  warpNearest(image, shift(-3, -2), cv::Size(60, 50), patch, valid);
  EXPECT_EQ(cv::countNonZero(valid), 57 * 48);
  EXPECT_EQ(valid(1, 10), 0);
  EXPECT_EQ(valid(10, 2), 0);
  EXPECT_EQ(valid(2, 3), 255);
  EXPECT_EQ(patch.at<unsigned char>(1, 1), 0);
  warpNearest(image, shift(1000, 1000), cv::Size(10, 10), patch, valid);
  EXPECT_EQ(cv::countNonZero(valid), 0);
}

TEST(WarpNearest, NothingIsValidBehindTheCamera) {
  const cv::Mat image(50, 60, CV_8UC1, cv::Scalar(9));
  cv::Mat patch;
  cv::Mat1b valid;
  warpNearest(image, -Eigen::Matrix3d::Identity(), cv::Size(10, 10), patch, valid);
  EXPECT_EQ(cv::countNonZero(valid), 0);
  warpNearest(image, Eigen::Matrix3d::Constant(std::nan("")), cv::Size(10, 10), patch, valid);
  EXPECT_EQ(cv::countNonZero(valid), 0);
}

TEST(WarpNearest, RefusesOtherTypes) {
  cv::Mat patch;
  cv::Mat1b valid;
  EXPECT_THROW(warpNearest(cv::Mat(5, 5, CV_16UC1), shift(0, 0), cv::Size(2, 2), patch, valid), std::invalid_argument);
}

TEST(SaturatedPixels, AnyChannelCountsAndTheMaskGrows) {
  cv::Mat patch(20, 20, CV_8UC3, cv::Scalar(10, 20, 30));
  patch.at<cv::Vec3b>(10, 10) = {0, 250, 0};
  patch.at<cv::Vec3b>(0, 0) = {249, 249, 249};
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

TEST(SaturatedPixels, TakesGreyImages) {
  cv::Mat patch(5, 5, CV_8UC1, cv::Scalar(251));
  cv::Mat1b mask;
  saturatedPixels(patch, 250, 2, mask);
  EXPECT_EQ(cv::countNonZero(mask), 25);
}

}  // namespace
}  // namespace laparoscope_servo::image
