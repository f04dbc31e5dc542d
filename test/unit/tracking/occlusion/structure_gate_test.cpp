#include "tracking/occlusion/structure_gate.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/synthetic_tissue.h"

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
  StructureStatistics statistics_;
  image::AreaGrid grid_{196, 196, 14, 14};

  static image::Patch patchOf(const cv::Mat1f& image) {
    image::Patch patch;
    patch.resize(image.cols, image.rows);
    image.copyTo(patch.view());
    return patch;
  }
  std::vector<float> gate(const cv::Mat1f& image, double gain = 1.0, double sigma = 3.0) {
    const image::Patch a = patchOf(image), b = patchOf(reference_);
    const PatchPair pair = {&a, &b};
    statistics_.compute(&pair, 1, patchOf(valid_), grid_);
    std::vector<float> d;
    for (int area = 0; area < grid_.count(); ++area) d.push_back(statistics_.dissimilarity(area, gain, sigma));
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
  for (float d : gate(darker, 1.25)) EXPECT_NEAR(d, 0.0f, 1e-3);
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
  EXPECT_EQ(rejected(gate(cv::Mat1f(kSize, 100.0f) + noise(kSize, 3.0, 2), 1.0, 3.0 * std::sqrt(2.0))), 0);
}

TEST_F(StructureGateTest, GivesTheMomentsOfAnAreasUsedPixels) {
  valid_(cv::Rect(0, 0, 14, 7)).setTo(0.0f);  // the upper half of area 0
  const cv::Mat1f image = reference_ + noise(kSize, 5.0, 1);
  gate(image);
  const cv::Rect lower(0, 7, 14, 7);
  cv::Scalar mean_a, dev_a, mean_b, dev_b;
  cv::meanStdDev(image(lower), mean_a, dev_a);
  cv::meanStdDev(reference_(lower), mean_b, dev_b);
  const AreaMoments& m = statistics_.area(0);
  EXPECT_FLOAT_EQ(m.share, 0.5f);
  EXPECT_NEAR(m.image, dev_a[0] * dev_a[0], 0.01 * m.image);
  EXPECT_NEAR(m.reference, dev_b[0] * dev_b[0], 0.01 * m.reference);
  EXPECT_NEAR(m.both, cv::mean((image(lower) - mean_a[0]).mul(reference_(lower) - mean_b[0]))[0], 0.01 * m.reference);
}

TEST_F(StructureGateTest, TakesTheMeanOverTheChannels) {
  const image::Patch a = patchOf(reference_ + noise(kSize, 5.0, 1)), b = patchOf(reference_),
                     flat = patchOf(cv::Mat1f(kSize, 9.0f));
  const PatchPair pairs[] = {{&a, &b}, {&flat, &flat}};
  statistics_.compute(pairs, 1, patchOf(valid_), grid_);
  const AreaMoments one = statistics_.area(17);
  statistics_.compute(pairs, 2, patchOf(valid_), grid_);
  const AreaMoments& two = statistics_.area(17);
  EXPECT_EQ(two.share, one.share);
  EXPECT_FLOAT_EQ(two.image, 0.5f * one.image);
  EXPECT_FLOAT_EQ(two.reference, 0.5f * one.reference);
  EXPECT_FLOAT_EQ(two.both, 0.5f * one.both);
}

TEST_F(StructureGateTest, IsNotANumberWhereTooLittleIsValid) {
  valid_(cv::Rect(0, 0, 14, 14)).setTo(0.0f);
  const std::vector<float> d = gate(reference_);
  EXPECT_TRUE(std::isnan(d[0]));
  EXPECT_FALSE(std::isnan(d[1]));
}

}  // namespace
}  // namespace laparoscope_servo::tracking
