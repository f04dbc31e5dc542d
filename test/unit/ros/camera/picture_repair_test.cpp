#include "ros/camera/picture_repair.h"

#include <gtest/gtest.h>

#include <array>
#include <stdexcept>

namespace laparoscope_servo {
namespace {

constexpr int kBlue = 0;
constexpr int kGreen = 1;
constexpr int kRed = 2;

// What a sensor with this filter sees of a plain colour.
cv::Mat mosaic(const cv::Vec3b& bgr, const std::array<int, 4>& channels) {
  cv::Mat raw(16, 16, CV_8UC1);
  for (int y = 0; y < raw.rows; ++y) {
    for (int x = 0; x < raw.cols; ++x) {
      raw.at<std::uint8_t>(y, x) = bgr[channels[static_cast<std::size_t>(2 * (y % 2) + x % 2)]];
    }
  }
  return raw;
}

TEST(PictureRepair, EachBayerPatternGivesTheColourBack) {
  const cv::Vec3b tissue(40, 90, 200);
  const std::array<std::pair<BayerPattern, std::array<int, 4>>, 4> patterns{{
      {BayerPattern::kRggb, {kRed, kGreen, kGreen, kBlue}},
      {BayerPattern::kBggr, {kBlue, kGreen, kGreen, kRed}},
      {BayerPattern::kGbrg, {kGreen, kBlue, kRed, kGreen}},
      {BayerPattern::kGrbg, {kGreen, kRed, kBlue, kGreen}},
  }};
  for (const auto& [pattern, channels] : patterns) {
    const cv::Mat raw = mosaic(tissue, channels);
    EXPECT_EQ(colourOf(raw, pattern).at<cv::Vec3b>(8, 8), tissue) << static_cast<int>(pattern);
    cv::Mat three;
    cv::merge(std::array<cv::Mat, 3>{raw, raw, raw}, three);
    EXPECT_EQ(colourOf(three, pattern).at<cv::Vec3b>(8, 8), tissue) << "as a decoder hands it over";
  }
}

TEST(PictureRepair, WhatIsNoPatternIsRefused) {
  EXPECT_THROW(colourOf(cv::Mat(16, 16, CV_16UC1), BayerPattern::kRggb), std::invalid_argument);
  EXPECT_THROW(colourOf(cv::Mat(1, 1, CV_8UC1), BayerPattern::kRggb), std::invalid_argument);
  EXPECT_THROW(colourOf(cv::Mat(16, 16, CV_8UC3, cv::Scalar(10, 90, 160)), BayerPattern::kRggb), std::invalid_argument)
      << "in colour already";
  EXPECT_NO_THROW(colourOf(cv::Mat(16, 16, CV_8UC3, cv::Scalar(90, 92, 91)), BayerPattern::kRggb)) << "a grey video";
  const cv::Mat picture(3, 3, CV_16UC1);
  EXPECT_EQ(colourOf(picture, BayerPattern::kNone).data, picture.data) << "untouched without a pattern";
}

TEST(PictureRepair, OfTwoHalfPicturesOneStays) {
  for (const int rows : {5, 6}) {
    cv::Mat picture(rows, 4, CV_8UC3);
    for (int y = 0; y < rows; ++y) picture.row(y) = y % 2 == 0 ? cv::Scalar::all(10 * y) : cv::Scalar::all(200);
    const cv::Mat upper = deinterlaced(picture, Interlacing::kUpper);
    for (int y = 0; y < rows; ++y) {
      const int expected = y == 5 ? 40 : 10 * y;  // a last line of the other half has one neighbour
      EXPECT_EQ(upper.at<cv::Vec3b>(y, 1), cv::Vec3b::all(static_cast<std::uint8_t>(expected))) << rows << ' ' << y;
    }
    const cv::Mat lower = deinterlaced(picture, Interlacing::kLower);
    for (int y = 0; y < rows; ++y) EXPECT_EQ(lower.at<cv::Vec3b>(y, 2), cv::Vec3b::all(200)) << rows << ' ' << y;
    EXPECT_EQ(deinterlaced(picture, Interlacing::kNone).data, picture.data);
  }
  const cv::Mat line(1, 4, CV_8UC1, cv::Scalar(7));
  EXPECT_EQ(deinterlaced(line, Interlacing::kUpper).at<std::uint8_t>(0, 0), 7);
}

}  // namespace
}  // namespace laparoscope_servo
