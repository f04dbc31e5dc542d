#include "tracking/occlusion/light_fit.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/synthetic_tissue.h"

namespace laparoscope_servo::tracking {
namespace {

const cv::Size kSize(140, 140);

image::ColourPatch patchOf(const cv::Mat& image) {
  image::ColourPatch patch;
  image::warpNearest(image, Eigen::Matrix3d::Identity(), image.size(), patch);
  return patch;
}

// gain * colour + offset, blue, green, red.
cv::Mat relit(const cv::Mat& image, const cv::Scalar& gain, const cv::Scalar& offset) {
  cv::Mat result;
  image.convertTo(result, CV_32F);
  cv::multiply(result, gain, result);
  result += offset;
  result.convertTo(result, CV_8U);
  return result;
}

class LightFitTest : public ::testing::Test {
 protected:
  image::AreaGrid grid_{kSize.width, kSize.height, 14, 14};
  LightFit fit_{grid_.count()};
  cv::Mat reference_ = cv::min(test::tissue(kSize, 4), 200);
  std::vector<char> all_ = std::vector<char>(grid_.count(), 1);

  AreaColours coloursOf(const cv::Mat& image) const {
    AreaColours colours;
    colours.compute(patchOf(image), grid_);
    return colours;
  }
  std::optional<LightFit::Result> fitOf(const cv::Mat& image, const ColourLight* start = nullptr) {
    return fit_.fit(coloursOf(image), coloursOf(reference_), all_, start);
  }
  // Grey levels, at the colours that tissue has.
  static void expectInverse(const ColourLight& light, const cv::Scalar& gain, const cv::Scalar& offset) {
    for (int c = 0; c < 3; ++c) {
      for (const double value : {60.0, 100.0, 140.0}) {
        EXPECT_NEAR(light[c].gain * (gain[c] * value + offset[c]) + light[c].offset, value, 3.0) << "channel " << c;
      }
    }
  }
};

TEST_F(LightFitTest, FindsAGainAndAnOffsetForEachChannel) {
  for (const auto& [gain, offset] : {std::pair{cv::Scalar(0.8, 1.0, 1.2), cv::Scalar(0, 0, 0)},
                                     std::pair{cv::Scalar(0.5, 0.5, 0.5), cv::Scalar(110, 110, 110)},
                                     std::pair{cv::Scalar(0.7, 0.9, 0.8), cv::Scalar(30, 10, 20)}}) {
    const auto found = fitOf(relit(reference_, gain, offset));
    ASSERT_TRUE(found);
    expectInverse(found->light, gain, offset);
    EXPECT_GT(found->correlation, 0.95);
  }
}

TEST_F(LightFitTest, IsThatOfTheMajority) {
  const cv::Scalar gain(1.2, 1.0, 0.8);
  cv::Mat image = relit(reference_, gain, {});
  image.rowRange(0, 56).setTo(cv::Scalar(120, 120, 120));  // four tenths
  const auto found = fitOf(image);
  ASSERT_TRUE(found);
  expectInverse(found->light, gain, {});
}

TEST_F(LightFitTest, OrThatOfTheAreasThatItIsToldToGoBy) {
  const cv::Scalar gain(1.1, 1.0, 0.9);
  cv::Mat image = relit(reference_, gain, {});
  image.rowRange(0, 110).setTo(cv::Scalar(120, 120, 120));
  for (int area = 0; area < grid_.count(); ++area) all_[area] = area / 14 >= 11;
  const ColourLight before;
  const auto found = fitOf(image, &before);
  ASSERT_TRUE(found);
  expectInverse(found->light, gain, {});
}

TEST_F(LightFitTest, CorrelatesASheetWithNothing) {
  cv::Mat sheet(kSize, CV_8UC3, cv::Scalar(90, 150, 70)), grain(kSize, CV_8UC3);
  cv::RNG(3).fill(grain, cv::RNG::UNIFORM, 0, 12);
  const auto found = fitOf(sheet + grain);
  if (found) {
    EXPECT_LT(found->correlation, 0.5);
  }
}

TEST_F(LightFitTest, AChannelThatClipsEverywhereHasTheGainOfTheOthers) {
  const cv::Scalar gain(1.25, 1.25, 5.0);
  const auto found = fitOf(relit(reference_, gain, {}));
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->light[0].gain, 0.8f, 0.05f);
  EXPECT_NEAR(found->light[2].gain, 0.5f * (found->light[0].gain + found->light[1].gain), 1e-5f);
}

TEST_F(LightFitTest, FindsNothingThatLightCannotBe) {
  EXPECT_FALSE(fitOf(relit(reference_, {0.1, 0.1, 0.1}, {100, 100, 100})));
  EXPECT_FALSE(fitOf(cv::Mat(kSize, CV_8UC3, cv::Scalar::all(255))));
  std::fill(all_.begin(), all_.end(), 0);
  EXPECT_FALSE(fitOf(reference_));
}

TEST(LargestDifference, IsOverAllValues) {
  ColourLight a, b;
  EXPECT_EQ(largestDifference(a, b), 0.0f);
  b[1] = {1.1f, 0.0f};
  EXPECT_NEAR(largestDifference(a, b), 25.5f, 1e-3);
  b[1] = {1.1f, -25.5f};
  EXPECT_NEAR(largestDifference(a, b), 25.5f, 1e-3);
}

TEST(AreaColours, TellNothingWhereTheAreaClipsOrIsNotSeen) {
  cv::Mat image(20, 20, CV_8UC3, cv::Scalar(50, 100, 150));
  image(cv::Rect(0, 0, 10, 3)).setTo(cv::Scalar(50, 100, 255));
  image::ColourPatch patch = patchOf(image);
  patch.valid(cv::Rect(10, 0, 10, 8)).setTo(0);
  AreaColours colours;
  colours.compute(patch, image::AreaGrid(20, 20, 2, 2));
  EXPECT_EQ(colours.count(), 4);
  EXPECT_EQ(colours.mean(0, 0), 50.0f);
  EXPECT_EQ(colours.mean(1, 0), 100.0f);
  EXPECT_TRUE(std::isnan(colours.mean(2, 0)));
  EXPECT_TRUE(std::isnan(colours.mean(0, 1)));
  EXPECT_EQ(colours.mean(2, 3), 150.0f);
}

}  // namespace
}  // namespace laparoscope_servo::tracking
