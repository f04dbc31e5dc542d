#include "laparoscope_servo/tracking/structure_gate.h"

#include <gtest/gtest.h>

#include <cmath>

#include "../../support/synthetic_tissue.h"

namespace laparoscope_servo::tracking {
namespace {

cv::Mat1f grey(const cv::Mat& image) {
  cv::Mat luma;
  cv::cvtColor(image, luma, cv::COLOR_BGR2GRAY);
  luma.convertTo(luma, CV_32F);
  return luma;
}

cv::Mat1f noise(const cv::Size& size, double sigma, unsigned seed) {
  cv::Mat1f n(size);
  cv::RNG rng(seed);
  rng.fill(n, cv::RNG::NORMAL, 0.0, sigma);
  return n;
}

const cv::Size kSize(196, 196);

class StructureGateTest : public ::testing::Test {
 protected:
  cv::Mat1f reference_ = grey(test::tissue(kSize, 4));
  cv::Mat1f valid_ = cv::Mat1f::ones(kSize);
  image::AreaGrid grid_{196, 196, 14, 14};

  std::vector<float> gate(const cv::Mat1f& image, const LightModel& light = LightModel(), double sigma = 3.0) {
    std::vector<float> d;
    structureDissimilarity(image, reference_, valid_, light, sigma, grid_, d);
    return d;
  }
  int rejected(const std::vector<float>& d) const {
    int n = 0;
    for (float x : d) n += x > kMaxDissimilarity;
    return n;
  }
};

TEST_F(StructureGateTest, KeepsTheReferenceItselfAndUnderNoise) {
  for (float d : gate(reference_)) EXPECT_NEAR(d, 0.0f, 1e-3);
  EXPECT_EQ(rejected(gate(reference_ + noise(kSize, 3.0, 1))), 0);
}

TEST_F(StructureGateTest, TakesTheLightOut) {
  const cv::Mat1f darker = 0.8 * reference_ - 5.0;
  for (float d : gate(darker, {1.25, 6.25})) EXPECT_NEAR(d, 0.0f, 1e-3);
}

TEST_F(StructureGateTest, ALocalShadeIsNoOccluder) {
  cv::Mat1f shaded = reference_.clone();
  shaded(cv::Rect(0, 0, 98, 196)) -= 30.0f;  // along the areas' border
  EXPECT_EQ(rejected(gate(shaded)), 0);
}

TEST_F(StructureGateTest, FindsOtherTissueOfTheSameColour) {
  const cv::Mat1f other = grey(test::tissue(kSize, 99));
  EXPECT_GT(rejected(gate(other)), 0.8 * 196);
  cv::Mat1f half = reference_.clone();
  other(cv::Rect(0, 0, 98, 196)).copyTo(half(cv::Rect(0, 0, 98, 196)));
  const std::vector<float> d = gate(half);
  int left = 0, right = 0;
  for (int area = 0; area < 196; ++area) (area % 14 < 7 ? left : right) += d[area] > kMaxDissimilarity;
  EXPECT_GT(left, 0.8 * 98);
  EXPECT_EQ(right, 0);
}

TEST_F(StructureGateTest, SaysNothingOfAreasThatHoldOnlyNoise) {
  reference_ = cv::Mat1f(kSize, 100.0f) + noise(kSize, 3.0, 1);
  EXPECT_EQ(rejected(gate(cv::Mat1f(kSize, 100.0f) + noise(kSize, 3.0, 2), LightModel(), 3.0 * std::sqrt(2.0))), 0);
}

TEST_F(StructureGateTest, IsNotANumberWhereTooLittleIsValid) {
  valid_(cv::Rect(0, 0, 14, 14)).setTo(0.0f);
  const std::vector<float> d = gate(reference_);
  EXPECT_TRUE(std::isnan(d[0]));
  EXPECT_FALSE(std::isnan(d[1]));
}

}  // namespace
}  // namespace laparoscope_servo::tracking
