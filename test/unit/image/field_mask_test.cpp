#include "laparoscope_servo/image/field_mask.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgproc.hpp>

namespace laparoscope_servo::image {
namespace {

constexpr int kRadius = 300;
const cv::Point kCentre(640, 360);

// A round picture of 1280x720 px with noise on the black beyond it.
cv::Mat roundPicture(int type) {
  cv::Mat image(720, 1280, type);
  cv::RNG random(5);
  random.fill(image, cv::RNG::UNIFORM, 0, 9);
  cv::circle(image, kCentre, kRadius, cv::Scalar(60, 60, 150), cv::FILLED);
  return image;
}

TEST(FieldMask, ARoundPictureIsBlackBeyondItsBorder) {
  for (const int type : {CV_8UC1, CV_8UC3}) {
    FieldMask field;
    field.look(roundPicture(type));
    ASSERT_FALSE(field.isWhole());
    const cv::Mat mask = field.joined(cv::Mat());
    ASSERT_EQ(mask.size(), cv::Size(1280, 720));
    for (int y = 0; y < mask.rows; ++y) {
      for (int x = 0; x < mask.cols; ++x) {
        const double from_centre = std::hypot(x - kCentre.x, y - kCentre.y);
        const int covered = mask.at<uchar>(y, x);
        if (from_centre > kRadius) {
          ASSERT_EQ(covered, 255) << x << ", " << y;
        } else if (from_centre < kRadius - 30) {
          ASSERT_EQ(covered, 0) << x << ", " << y;
        }
      }
    }
  }
}

TEST(FieldMask, WhatCoversTheTissueIsKeptWithinTheField) {
  FieldMask field;
  field.look(roundPicture(CV_8UC3));
  cv::Mat instrument = cv::Mat::zeros(720, 1280, CV_8UC1);
  instrument(cv::Rect(600, 300, 50, 40)).setTo(7);
  const cv::Mat mask = field.joined(instrument);
  const cv::Mat alone = field.joined(cv::Mat()).clone();
  EXPECT_EQ(cv::countNonZero(field.joined(instrument)), cv::countNonZero(alone) + 50 * 40);
  EXPECT_EQ(mask.at<uchar>(320, 620), 255);
}

TEST(FieldMask, APictureWithoutBorderLeavesTheMaskAsItIs) {
  FieldMask field;
  field.look(cv::Mat(480, 640, CV_8UC3, cv::Scalar(60, 60, 150)));
  EXPECT_TRUE(field.isWhole());
  const cv::Mat mask = cv::Mat::zeros(480, 640, CV_8UC1);
  EXPECT_EQ(field.joined(mask).data, mask.data);
  EXPECT_TRUE(field.joined(cv::Mat()).empty());
  EXPECT_TRUE(field.contains({0, 0, 640, 480}));
  EXPECT_EQ(field.shareBeyond({0, 0, 100, 100}), 0.0);
}

TEST(FieldMask, WhereTheImageCutsTheFieldOffNothingIsLost) {
  cv::Mat image(720, 1280, CV_8UC3, cv::Scalar::all(3));
  cv::circle(image, kCentre, 500, cv::Scalar(60, 60, 150), cv::FILLED);  // beyond the image's upper and lower edge
  FieldMask field;
  field.look(image);
  const cv::Mat mask = field.joined(cv::Mat());
  EXPECT_EQ(cv::countNonZero(mask.row(0).colRange(400, 880)), 0);
  EXPECT_EQ(cv::countNonZero(mask.row(719).colRange(400, 880)), 0);
  EXPECT_EQ(mask.at<uchar>(360, 100), 255);
}

TEST(FieldMask, AnImageThatIsBlackAllOverHasNoBorder) {
  FieldMask field;
  field.look(cv::Mat(480, 640, CV_8UC1, cv::Scalar(4)));
  EXPECT_TRUE(field.isWhole());
}

TEST(FieldMask, SaysWhichRectanglesAreWithinIt) {
  FieldMask field;
  field.look(roundPicture(CV_8UC3));
  EXPECT_TRUE(field.contains({500, 250, 200, 200}));
  EXPECT_FALSE(field.contains({300, 250, 200, 200})) << "across the border";
  EXPECT_FALSE(field.contains({0, 0, 50, 50}));
  EXPECT_FALSE(field.contains({-40, 250, 100, 100})) << "in part outside of the image";
  EXPECT_EQ(field.shareBeyond({500, 250, 200, 200}), 0.0);
  EXPECT_EQ(field.shareBeyond({0, 0, 50, 50}), 1.0);
  EXPECT_NEAR(field.shareBeyond({240, 320, 200, 80}), 0.55, 0.1);
}

TEST(FieldMask, WorksOnTheSmallestImages) {
  for (const cv::Size& size : {cv::Size(1, 1), cv::Size(3, 2), cv::Size(200, 1)}) {
    FieldMask field;
    field.look(cv::Mat(size, CV_8UC3, cv::Scalar::all(120)));
    EXPECT_TRUE(field.joined(cv::Mat()).empty() || field.joined(cv::Mat()).size() == size);
  }
}

}  // namespace
}  // namespace laparoscope_servo::image
