#include "laparoscope_servo/tracking/external_masks.h"

#include <gtest/gtest.h>

namespace laparoscope_servo::tracking {
namespace {

const cv::Size kSize(640, 480);
constexpr double kPeriod = 0.04;   // s
constexpr double kMaxAge = 0.101;  // s

// A shaft that enters from the left, up to `tip`.
cv::Mat shaft(int tip) {
  cv::Mat mask = cv::Mat::zeros(kSize, CV_8UC1);
  mask(cv::Rect(0, 200, tip, 60)).setTo(255);
  return mask;
}

double uncovered(const cv::Mat& truth, const cv::Mat& mask) {
  return static_cast<double>(cv::countNonZero(truth & ~mask)) / cv::countNonZero(truth);
}

TEST(ExternalMasks, OfTheImageItselfItIsUsedAsItIsWithoutACopy) {
  ExternalMasks masks(kMaxAge);
  const cv::Mat before = shaft(100), now = shaft(120);
  masks.add(before, 1.0);
  masks.add(now, 1.04);
  const ExternalMask used = masks.at(1.04, kSize);
  EXPECT_EQ(used.mask.data, now.data);
  EXPECT_EQ(used.age, 0.0);
  EXPECT_EQ(used.grown, 0.0);
  EXPECT_EQ(masks.at(1.0, kSize).mask.data, before.data) << "that of an image that was waiting";
}

TEST(ExternalMasks, AnEarlierOneIsGrownByWhatItMoves) {
  for (const int step : {4, 8, 20}) {
    ExternalMasks masks(kMaxAge);
    masks.add(shaft(200), 1.0);
    masks.add(shaft(200 + step), 1.0 + kPeriod);
    for (int late = 1; late <= 2; ++late) {
      const ExternalMask used = masks.at(1.0 + (1 + late) * kPeriod, kSize);
      ASSERT_FALSE(used.mask.empty());
      EXPECT_NEAR(used.age, late * kPeriod, 1e-9);
      EXPECT_NEAR(used.grown, late * step, 0.05 * late * step + 2.0 * late + 1.0) << step;
      EXPECT_LT(uncovered(shaft(200 + step + late * step), used.mask), 0.02) << step << ' ' << late;
    }
  }
}

TEST(ExternalMasks, OneThatRestsOrLeavesDoesNotGrow) {
  ExternalMasks masks(kMaxAge);
  masks.add(shaft(200), 1.0);
  masks.add(shaft(200), 1.04);
  EXPECT_EQ(masks.at(1.08, kSize).grown, 0.0);
  masks.add(shaft(180), 1.08);
  EXPECT_EQ(masks.at(1.12, kSize).grown, 0.0);
  EXPECT_EQ(cv::countNonZero(masks.at(1.12, kSize).mask), 180 * 60);
}

// What appears has not come from afar within one image.
TEST(ExternalMasks, OneThatAppearsIsGrownByWhatIsUsual) {
  ExternalMasks appears(kMaxAge);
  appears.add(shaft(1) * 0, 1.0);
  appears.add(shaft(300), 1.04);
  const double usual = appears.at(1.08, kSize).grown;
  EXPECT_GT(usual, 0.0);
  EXPECT_LT(usual, 0.05 * kSize.width);
  ExternalMasks alone(kMaxAge);
  alone.add(shaft(300), 1.04);
  EXPECT_EQ(alone.at(1.08, kSize).grown, usual);
}

TEST(ExternalMasks, ASecondOneThatAppearsDoesNotGrowTheFirst) {
  ExternalMasks masks(kMaxAge);
  masks.add(shaft(200), 1.0);
  cv::Mat both = shaft(200);
  both(cv::Rect(500, 0, 60, 60)).setTo(255);
  masks.add(both, 1.04);
  EXPECT_EQ(masks.at(1.08, kSize).grown, 0.0);
}

TEST(ExternalMasks, ValuesOtherThanZeroAreAllCovered) {
  ExternalMasks ones(kMaxAge), full(kMaxAge);
  for (int k = 0; k < 2; ++k) {
    ones.add(shaft(200 + 20 * k) / 255, 1.0 + kPeriod * k);
    full.add(shaft(200 + 20 * k), 1.0 + kPeriod * k);
  }
  const ExternalMask a = ones.at(1.08, kSize), b = full.at(1.08, kSize);
  EXPECT_EQ(a.grown, b.grown);
  EXPECT_EQ(cv::countNonZero(a.mask), cv::countNonZero(b.mask));
}

TEST(ExternalMasks, OneThatIsTooOldIsNotUsed) {
  ExternalMasks masks(kMaxAge);
  masks.add(shaft(200), 1.0);
  EXPECT_FALSE(masks.at(1.1, kSize).mask.empty());
  EXPECT_TRUE(masks.at(1.11, kSize).mask.empty());
  ExternalMasks own(0.0);
  own.add(shaft(200), 1.0);
  EXPECT_FALSE(own.at(1.0, kSize).mask.empty());
  EXPECT_TRUE(own.at(1.001, kSize).mask.empty());
}

TEST(ExternalMasks, OneOfALaterImageIsNotUsed) {
  ExternalMasks masks(kMaxAge);
  masks.add(shaft(200), 1.0);
  EXPECT_TRUE(masks.at(0.96, kSize).mask.empty());
  masks.add(shaft(210), 1.08);
  EXPECT_NEAR(masks.at(1.04, kSize).age, kPeriod, 1e-9);
}

TEST(ExternalMasks, OneOfAnotherSizeIsNotUsed) {
  ExternalMasks masks(kMaxAge);
  masks.add(shaft(200), 1.0);
  EXPECT_TRUE(masks.at(1.0, cv::Size(320, 240)).mask.empty());
  EXPECT_TRUE(masks.at(1.04, cv::Size(320, 240)).mask.empty());
}

TEST(ExternalMasks, ATimeThatJumpsBackForgetsThoseBefore) {
  ExternalMasks masks(kMaxAge);
  masks.add(shaft(200), 1.0);
  masks.add(shaft(210), 0.5);
  EXPECT_TRUE(masks.at(1.0, kSize).mask.empty());
  EXPECT_EQ(cv::countNonZero(masks.at(0.5, kSize).mask), 210 * 60);
}

TEST(ExternalMasks, ManyComeAndThePixelsOfAllButTheLastAreGivenBack) {
  ExternalMasks masks(kMaxAge);
  std::vector<std::weak_ptr<const int>> holders;
  for (int k = 0; k < 100; ++k) {
    const auto holder = std::make_shared<const int>(k);
    holders.push_back(holder);
    masks.add(shaft(100 + k), 1.0 + kPeriod * k, holder);
    EXPECT_EQ(masks.at(1.0 + kPeriod * k, kSize).age, 0.0);
  }
  EXPECT_TRUE(holders[50].expired());
  EXPECT_FALSE(holders[99].expired());
  masks.clear();
  EXPECT_TRUE(holders[99].expired());
  EXPECT_TRUE(masks.at(1.0 + kPeriod * 99, kSize).mask.empty());
}

TEST(CoveredShare, IsThatOfTheRegionsArea) {
  const geometry::Quadrilateral right = geometry::Rectangle{150.0, 200.0, 100.0, 60.0}.corners();
  EXPECT_EQ(coveredShare(cv::Mat(), right), 0.0);
  EXPECT_NEAR(coveredShare(shaft(200), right), 0.5, 0.03);
  EXPECT_EQ(coveredShare(shaft(300), right), 1.0);
  EXPECT_EQ(coveredShare(shaft(100), right), 0.0);
  // Half of it lies outside of the image, and is not covered by anything.
  EXPECT_NEAR(coveredShare(shaft(300), geometry::Rectangle{-50.0, 200.0, 100.0, 60.0}.corners()), 0.5, 0.03);
  geometry::Quadrilateral nowhere = right;
  nowhere[2] = Eigen::Vector2d::Constant(std::numeric_limits<double>::quiet_NaN());
  EXPECT_GE(coveredShare(shaft(300), nowhere), 0.0);
}

}  // namespace
}  // namespace laparoscope_servo::tracking
