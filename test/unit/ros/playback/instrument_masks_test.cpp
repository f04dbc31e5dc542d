#include "ros/playback/instrument_masks.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <vector>

#include "support/instrument_scene.h"

namespace laparoscope_servo {
namespace {

constexpr double kPeriod = 0.04;  // s

InstrumentMaskOptions options(int late) {
  InstrumentMaskOptions options;
  options.late = late;
  options.max_age = 0.1;
  return options;
}

ros::Time stampOf(int image) {
  return ros::Time(1000.0) + ros::Duration(kPeriod * image);
}

// An image of the shaft, by `step` px further in each image.
cv::Mat image(int k, double step) {
  return test_support::instrumentScene(step * k, static_cast<unsigned>(k));
}

TEST(InstrumentMasks, AreOfTheImageItself) {
  InstrumentMasks masks(options(0));
  model::InstrumentTracker alone;
  for (int k = 0; k < 12; ++k) {
    const tracking::ExternalMask mask = masks.of(image(k, 2.0), stampOf(k));
    const cv::Mat& expected = alone.track(image(k, 2.0), stampOf(k).toSec()).mask;
    ASSERT_EQ(mask.mask.size(), cv::Size(320, 240));
    EXPECT_EQ(mask.age, 0.0);
    EXPECT_EQ(cv::norm(mask.mask, expected, cv::NORM_INF), 0.0) << k;
  }
  EXPECT_GT(cv::countNonZero(alone.result().mask), 3000);
}

TEST(InstrumentMasks, ThatComeLateAreThoseBeforeAsPredicted) {
  for (const int late : {1, 2}) {
    InstrumentMasks masks(options(late));
    InstrumentMasks at_once(options(0));
    std::vector<cv::Mat> own;
    int missed = 0, missed_as_it_was = 0;
    for (int k = 0; k < 12; ++k) {
      own.push_back(at_once.of(image(k, 3.0), stampOf(k)).mask.clone());
      const tracking::ExternalMask mask = masks.of(image(k, 3.0), stampOf(k));
      EXPECT_EQ(mask.mask.empty(), k < late) << k;
      if (k < 8) continue;
      EXPECT_NEAR(mask.age, late * kPeriod, 1e-6);
      EXPECT_GT(mask.grown, 0.0);
      missed += cv::countNonZero(own.back() & ~mask.mask);
      missed_as_it_was += cv::countNonZero(own.back() & ~own[static_cast<std::size_t>(k - late)]);
    }
    // Silhouettes flicker, but most of what moved on is covered.
    EXPECT_GT(missed_as_it_was, 0);
    EXPECT_LT(missed, 0.4 * missed_as_it_was) << late;
  }
}

TEST(InstrumentMasks, BeginAnewWhenTimeJumpsBack) {
  InstrumentMasks masks(options(1));
  for (int k = 100; k < 108; ++k) masks.of(image(k - 100, 0.0), stampOf(k));
  EXPECT_TRUE(masks.of(image(8, 0.0), stampOf(0)).mask.empty());
  EXPECT_FALSE(masks.of(image(9, 0.0), stampOf(1)).mask.empty());
}

TEST(InstrumentMasks, RefuseImagesWithoutColourAndImpossibleDelays) {
  InstrumentMasks masks(options(0));
  EXPECT_THROW(masks.of(cv::Mat::zeros(240, 320, CV_8UC1), stampOf(0)), std::invalid_argument);
  EXPECT_NO_THROW(masks.of(image(0, 0.0), stampOf(1)));
  EXPECT_THROW(InstrumentMasks(options(-1)), std::invalid_argument);
  EXPECT_THROW(InstrumentMasks(options(101)), std::invalid_argument);
}

}  // namespace
}  // namespace laparoscope_servo
