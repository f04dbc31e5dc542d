#include "tracking/occlusion/highlight_mask.h"

#include <gtest/gtest.h>

#include <Eigen/Core>

#include "laparoscope_servo/image/warp.h"

namespace laparoscope_servo::tracking {
namespace {

const cv::Size kSize(40, 20);
constexpr std::array<bool, 3> kAll = {true, true, true};

// Every step-th pixel.
image::ColourPatch sampled(const cv::Mat& image, int step) {
  image::ColourPatch patch;
  Eigen::Matrix3d image_T_sample = Eigen::Matrix3d::Identity();
  image_T_sample.leftCols<2>() *= step;
  image::warpNearest(image, image_T_sample, {(image.cols + step - 1) / step, (image.rows + step - 1) / step}, patch);
  return patch;
}

cv::Mat dark() {
  return cv::Mat(kSize, CV_8UC3, cv::Scalar(60, 70, 120));
}

// Areas of 10 x 10 px.
HighlightMask maskOf(const cv::Mat& reference, int step = 1, const std::array<bool, 3>& tracked = kAll) {
  const image::ColourPatch patch = sampled(reference, step);
  HighlightMask mask(250);
  mask.setReference(patch, kSize, image::AreaGrid(patch.size().width, patch.size().height, 2, 4), step, tracked);
  return mask;
}

int unusable(const HighlightMask& mask) {
  return static_cast<int>(mask.usable().view().total()) - cv::countNonZero(mask.usable().view());
}

TEST(HighlightMask, LeavesOutHighlightsOfBothImagesWithTheirRim) {
  cv::Mat reference = dark(), current = dark();
  reference(cv::Rect(5, 5, 1, 1)) = cv::Scalar(255, 255, 255);
  current(cv::Rect(30, 12, 1, 1)) = cv::Scalar(255, 255, 255);
  HighlightMask mask = maskOf(reference);
  EXPECT_EQ(mask.usable()(5, 5), 0.0f);
  EXPECT_EQ(mask.usable()(12, 30), 1.0f);
  const int of_one = unusable(mask);
  EXPECT_GE(of_one, 9);
  EXPECT_LE(of_one, 25);
  mask.observe(sampled(current, 1));
  EXPECT_EQ(mask.usable()(5, 5), 0.0f);
  EXPECT_EQ(mask.usable()(12, 30), 0.0f);
  EXPECT_EQ(unusable(mask), 2 * of_one);
  mask.observe(sampled(dark(), 1));
  EXPECT_EQ(unusable(mask), of_one);
}

TEST(HighlightMask, SaturationCountsInTheTrackedChannelsOnly) {
  cv::Mat red = dark();
  red(cv::Rect(5, 5, 4, 4)) = cv::Scalar(60, 70, 255);
  EXPECT_GT(unusable(maskOf(red)), 0);
  EXPECT_EQ(unusable(maskOf(red, 1, {true, true, false})), 0);
}

// More than half of a region is no highlight but the light: more of what is left can be used.
TEST(HighlightMask, GrowsLessWhereMostIsSaturated) {
  const auto rim = [](int width) {
    cv::Mat image = dark();
    image(cv::Rect(0, 0, width, kSize.height)) = cv::Scalar(255, 255, 255);
    return unusable(maskOf(image)) / kSize.height - width;
  };
  EXPECT_EQ(rim(17), 2);
  EXPECT_EQ(rim(25), 1);
}

TEST(HighlightMask, ASampleStandsForItsPixels) {
  cv::Mat image = dark();
  image(cv::Rect(20, 10, 1, 1)) = cv::Scalar(255, 255, 255);
  const HighlightMask mask = maskOf(image, 2);
  EXPECT_EQ(mask.usable()(10, 20), 0.0f);
  EXPECT_EQ(mask.usable()(11, 21), 0.0f);
  EXPECT_EQ(mask.usable()(0, 0), 1.0f);
  EXPECT_EQ(mask.usable()(kSize.height - 1, kSize.width - 1), 1.0f);
  EXPECT_EQ(unusable(mask) % 4, 0);
}

TEST(HighlightMask, SaysWhatHidesAnArea) {
  HighlightMask mask = maskOf(dark());
  for (int area = 0; area < 8; ++area) EXPECT_EQ(mask.hidden(area), AreaCause::kNone) << area;
  cv::Mat current = dark();
  current(cv::Rect(0, 0, 10, 10)) = cv::Scalar(255, 255, 255);
  image::ColourPatch patch = sampled(current, 1);
  patch.valid(cv::Rect(30, 10, 10, 10)).setTo(0);
  patch.valid(cv::Rect(10, 0, 10, 4)).setTo(0);  // less than half of an area
  mask.observe(patch);
  EXPECT_EQ(mask.hidden(0), AreaCause::kHighlight);
  EXPECT_EQ(mask.hidden(7), AreaCause::kBorder);
  EXPECT_EQ(mask.usable()(15, 35), 0.0f);
  EXPECT_EQ(mask.hidden(2), AreaCause::kNone);
}

TEST(HighlightMask, WhatIsHiddenInTheReferenceStaysOut) {
  HighlightMask mask = maskOf(dark());
  cv::Mat1b covered = cv::Mat1b::zeros(kSize);
  covered(cv::Rect(0, 0, 10, 20)).setTo(255);
  mask.hideInReference(covered);
  EXPECT_EQ(unusable(mask), 200);
  mask.observe(sampled(dark(), 1));
  EXPECT_EQ(unusable(mask), 200);
}

}  // namespace
}  // namespace laparoscope_servo::tracking
