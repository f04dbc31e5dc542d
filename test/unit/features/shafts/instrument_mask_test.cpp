#include "laparoscope_servo/features/instrument_mask.h"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

#include "support/synthetic_instrument.h"

namespace laparoscope_servo::features {
namespace {

using test_support::drawShaft;
using test_support::ShaftPicture;
using test_support::ShaftScene;

double shareOf(const cv::Mat& part, const cv::Mat& whole) {
  return static_cast<double>(cv::countNonZero(part & whole)) / cv::countNonZero(whole);
}

TEST(InstrumentMask, CoversTheShaftAndLittleBesides) {
  const ShaftPicture picture = drawShaft(ShaftScene());
  const cv::Mat mask = instrumentMask(picture.image);
  ASSERT_EQ(mask.size(), picture.image.size());
  ASSERT_EQ(mask.type(), CV_8UC1);
  EXPECT_GT(shareOf(mask, picture.mask), 0.98);
  EXPECT_GT(shareOf(picture.mask, mask), 0.8);
}

TEST(InstrumentMask, IsEmptyWhereThereIsNone) {
  ShaftScene scene;
  scene.with_shaft = false;
  for (int seed = 1; seed <= 20; ++seed) {
    scene.seed = seed;
    EXPECT_TRUE(instrumentMask(drawShaft(scene).image).empty()) << seed;
  }
}

TEST(InstrumentMask, ScalesWithThePicture) {
  const ShaftPicture picture = drawShaft(ShaftScene());
  for (const double scale : {0.4, 2.25}) {
    cv::Mat image, truth;
    cv::resize(picture.image, image, {}, scale, scale, cv::INTER_AREA);
    cv::resize(picture.mask, truth, {}, scale, scale, cv::INTER_NEAREST);
    const cv::Mat mask = instrumentMask(image);
    ASSERT_FALSE(mask.empty()) << scale;
    EXPECT_GT(shareOf(mask, truth), 0.97) << scale;
  }
}

// A strip of pale tissue: redder than grey, and no step of brightness.
TEST(InstrumentMask, PaleTissueIsNoInstrument) {
  ShaftScene scene;
  scene.shaft = cv::Scalar(80, 105, 150);
  EXPECT_TRUE(instrumentMask(drawShaft(scene).image).empty());
}

// On a table, say, all is grey, and what has straight edges is no instrument for it.
TEST(InstrumentMask, TellsNothingOfAPictureThatIsGrey) {
  ShaftScene scene;
  scene.tissue = cv::Scalar(100, 102, 112);
  EXPECT_TRUE(instrumentMask(drawShaft(scene).image).empty());
}

TEST(InstrumentMask, TellsNothingOfGreyImagesAndVerySmallOnes) {
  cv::Mat grey, small;
  const cv::Mat image = drawShaft(ShaftScene()).image;
  cv::cvtColor(image, grey, cv::COLOR_BGR2GRAY);
  cv::resize(image, small, {63, 63});
  EXPECT_TRUE(instrumentMask(grey).empty());
  EXPECT_TRUE(instrumentMask(small).empty());
  EXPECT_TRUE(instrumentMask(cv::Mat()).empty());
}

TEST(InstrumentMask, GivesTheSameForTheSameImage) {
  const cv::Mat image = drawShaft(ShaftScene()).image;
  const cv::Mat first = instrumentMask(image), second = instrumentMask(image);
  EXPECT_EQ(cv::norm(first, second, cv::NORM_INF), 0.0);
}

}  // namespace
}  // namespace laparoscope_servo::features
