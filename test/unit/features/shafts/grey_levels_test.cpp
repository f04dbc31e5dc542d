#include "features/shafts/grey_levels.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace laparoscope_servo::features {
namespace {

const cv::Scalar kTissue(60, 70, 170), kSteel(150, 145, 135);  // blue, green, red

// Columns of steel, then tissue, with noise. `exposure` makes it darker.
cv::Mat picture(double steel, double exposure = 1.0, const cv::Size& size = {200, 150}) {
  cv::Mat image(size, CV_8UC3, kTissue * exposure);
  const int columns = static_cast<int>(steel * size.width);
  if (columns > 0) image(cv::Rect(0, 0, columns, size.height)).setTo(kSteel * exposure);
  cv::Mat noise(size, CV_16SC3), wide;
  cv::RNG(7).fill(noise, cv::RNG::NORMAL, 0.0, 2.0);
  image.convertTo(wide, CV_16SC3);
  cv::Mat(wide + noise).convertTo(image, CV_8UC3);
  return image;
}

struct Seen {
  GreyMap map;
  image::FieldOfView view;
  GreyLevels levels;

  explicit Seen(const cv::Mat& image) {
    map.compute(image);
    view.compute(map.level());
    levels = greyLevels(map, view);
  }
  double shareBelow(const cv::Range& columns) const {
    const cv::Mat1b part = map.colour()(cv::Range::all(), columns);
    return static_cast<double>(
               std::count_if(part.begin(), part.end(), [this](uchar c) { return c < levels.threshold; })) /
           static_cast<double>(part.total());
  }
};

TEST(GreyLevels, SteelIsBelowTheThresholdAndTissueAboveWhateverShareTheyHave) {
  for (const double steel : {0.05, 0.2, 0.4, 0.5}) {
    const Seen seen(picture(steel));
    ASSERT_EQ(seen.map.step(), 1);
    const int border = static_cast<int>(steel * 200);
    EXPECT_GT(seen.shareBelow({0, border}), 0.95) << steel;
    EXPECT_EQ(seen.shareBelow({border, 200}), 0.0) << steel;
  }
}

TEST(GreyLevels, TheUsualColourIsTheTissuesUnlessMostOfThePictureIsGrey) {
  // Redder than 0.75 is not told apart, and the colour of this tissue is 105 / 100.
  for (const double steel : {0.0, 0.2, 0.35}) EXPECT_NEAR(Seen(picture(steel)).levels.usual, 0.75, 0.01) << steel;
  EXPECT_NEAR(Seen(picture(1.0)).levels.usual, 0.0, 0.1);
}

TEST(GreyLevels, ExposureDoesNotMatter) {
  const GreyLevels bright = Seen(picture(0.3)).levels, dark = Seen(picture(0.3, 0.5)).levels;
  EXPECT_NEAR(bright.threshold, dark.threshold, 0.08 * GreyMap::kUnit);
  EXPECT_NEAR(bright.usual, dark.usual, 0.02);
}

TEST(GreyLevels, WithoutASecondKindTheThresholdKeepsToItsBounds) {
  const Seen tissue(picture(0.0)), steel(picture(1.0));
  EXPECT_LE(tissue.levels.threshold, GreyMap::kZero + 0.4 * GreyMap::kUnit);
  EXPECT_EQ(tissue.shareBelow(cv::Range::all()), 0.0) << "tissue alone is not grey";
  EXPECT_GE(steel.levels.threshold, GreyMap::kZero + 0.06 * GreyMap::kUnit);
}

TEST(GreyLevels, WhatLiesBeyondTheFieldOfViewDoesNotCount) {
  const cv::Mat inner = picture(0.65, 1.0, {140, 150});
  const GreyLevels alone = Seen(inner).levels;
  cv::Mat framed = cv::Mat::zeros(inner.rows, inner.cols + 100, CV_8UC3);
  inner.copyTo(framed(cv::Rect(50, 0, inner.cols, inner.rows)));
  const Seen seen(framed);
  ASSERT_EQ(seen.map.step(), 1);
  ASSERT_FALSE(seen.view.contains(5, 75));
  EXPECT_NEAR(seen.levels.threshold, alone.threshold, 1.0);
  EXPECT_NEAR(seen.levels.usual, alone.usual, 0.01);
}

}  // namespace
}  // namespace laparoscope_servo::features
