#include "tracking/esm/residual.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "support/synthetic_tissue.h"

namespace laparoscope_servo::tracking {
namespace {

const geometry::Rectangle kRoi = {30, 20, 120, 100};

// The image is (reference + noise - offset) / gain: gain * image + offset = reference + noise.
class ResidualTest : public ::testing::TestWithParam<double> {
 protected:
  const double gain_ = GetParam();
  EsmLevel level_ = levelOf(image::kLuma);

  static EsmLevel levelOf(const image::Channels& channels) {
    image::RegionPyramid reference;
    reference.build(test::tissue(cv::Size(180, 150), 4), cv::Rect(0, 0, 180, 150), 1, channels);
    EsmLevel level(reference, kRoi, 0);
    level.centreLight();
    return level;
  }
  void warp(EsmPlane& plane, double offset, double noise) {
    cv::Mat1f grain(level_.height, level_.width);
    cv::RNG rng(3);
    rng.fill(grain, cv::RNG::NORMAL, 0.0, std::max(noise, 1e-9));
    cv::Mat1f(cv::Mat((plane.value.view() + grain - offset) / gain_)).copyTo(plane.warped.view());
    // Of each block, so that biasOf is the offset: see EsmPlane.
    for (std::size_t block = 0; block < plane.bias.size(); ++block) {
      plane.bias[block] = offset - (1.0 - gain_) * plane.mean[block];
    }
  }
};

TEST_P(ResidualTest, MatchingLeavesNoMean) {
  EsmPlane& plane = level_.planes[0];
  warp(plane, 12.0, 0.0);
  for (double& bias : plane.bias) bias -= 5.0;
  const std::vector<double> before = plane.bias;
  EXPECT_NEAR(matchMean(level_, gain_), 5.0, 1e-3);
  for (std::size_t block = 0; block < before.size(); ++block) EXPECT_NEAR(plane.bias[block], before[block] + 5.0, 1e-3);
  EXPECT_NEAR(matchMean(level_, gain_), 0.0, 1e-3);
}

TEST_P(ResidualTest, MatchingAsksOnlyPixelsWithWeight) {
  EsmPlane& plane = level_.planes[0];
  warp(plane, 12.0, 0.0);
  plane.warped.view()(cv::Rect(0, 0, 60, 100)).setTo(255.0f);
  level_.weight.view()(cv::Rect(0, 0, 60, 100)).setTo(0.0f);
  EXPECT_NEAR(matchMean(level_, gain_), 0.0, 1e-3);
  level_.weight.view().setTo(0.0f);
  EXPECT_EQ(matchMean(level_, gain_), 0.0);
}

TEST_P(ResidualTest, EachPlaneIsMatchedForItself) {
  level_ = levelOf({{1, 0, 0}, {0, 1, 0}, {0, 0, 1}});
  for (int c = 0; c < 3; ++c) {
    warp(level_.planes[c], 0.0, 0.0);
    for (double& bias : level_.planes[c].bias) bias -= 3.0 * c;
  }
  EXPECT_NEAR(matchMean(level_, gain_), 3.0, 1e-3);  // of 0, 3 and 6
  EXPECT_NEAR(matchMean(level_, gain_), 0.0, 1e-3);
}

TEST_P(ResidualTest, TheScaleIsThatOfNormalNoise) {
  for (const double noise : {2.0, 5.0, 15.0}) {
    warp(level_.planes[0], -7.0, noise);
    EXPECT_NEAR(ResidualScale().of(level_, gain_), noise, 0.1 * noise);
  }
}

TEST_P(ResidualTest, TheScaleBearsOutliersAndSkipsPixelsWithoutWeight) {
  warp(level_.planes[0], 0.0, 5.0);
  const double clean = ResidualScale().of(level_, gain_);
  level_.planes[0].warped.view()(cv::Rect(0, 0, 24, 100)).setTo(2000.0f);
  EXPECT_LT(ResidualScale().of(level_, gain_), 1.5 * clean);  // a fifth
  level_.planes[0].warped.view()(cv::Rect(0, 0, 80, 100)).setTo(2000.0f);
  EXPECT_GT(ResidualScale().of(level_, gain_), 10.0 * clean);  // two thirds
  level_.weight.view()(cv::Rect(0, 0, 80, 100)).setTo(0.0f);
  EXPECT_NEAR(ResidualScale().of(level_, gain_), clean, 0.2 * clean);
}

TEST_P(ResidualTest, TheScaleIsNeverBelowQuantisation) {
  warp(level_.planes[0], 0.0, 0.0);
  ResidualScale scale;
  EXPECT_EQ(scale.of(level_, gain_), 1.0);
  warp(level_.planes[0], 0.0, 5.0);
  EXPECT_GT(scale.of(level_, gain_), 4.0);
  level_.weight.view().setTo(0.0f);
  EXPECT_EQ(scale.of(level_, gain_), 1.0);
}

// A quarter of the pixels lies far off: the median of all is too large by a third, that of those kept is not.
TEST_P(ResidualTest, TheScaleOfWhatIsKeptLeavesOutTheRest) {
  EsmPlane& plane = level_.planes[0];
  warp(plane, 12.0, 4.0);
  plane.warped.view()(cv::Rect(0, 0, 30, 100)) += 60.0f / static_cast<float>(gain_);
  ResidualScale scale;
  double sigma = scale.of(level_, gain_);
  EXPECT_GT(sigma, 4.8);
  for (int k = 0; k < 4; ++k) sigma = scale.ofKept(sigma);
  EXPECT_NEAR(sigma, 4.0, 0.4);
  EXPECT_EQ(scale.ofKept(1e-6), 1.0) << "none is kept";
}

TEST_P(ResidualTest, TheCostIsTukeysMeanRho) {
  EsmPlane& plane = level_.planes[0];
  warp(plane, 12.0, 1e-3);
  ResidualScale scale;
  scale.of(level_, gain_);
  EXPECT_LT(scale.cost(2.0), 0.01);
  EXPECT_GT(scale.count(), 500);
  plane.warped.view()(cv::Rect(0, 0, 60, 100)) += 60.0f / static_cast<float>(gain_);
  scale.of(level_, gain_);
  EXPECT_NEAR(scale.cost(2.0), 0.5, 0.05) << "half of them cost 1";
  level_.weight.view().setTo(0.0f);
  scale.of(level_, gain_);
  EXPECT_EQ(scale.count(), 0);
  EXPECT_EQ(scale.cost(2.0), 1.0);
}

INSTANTIATE_TEST_SUITE_P(Gains, ResidualTest, ::testing::Values(1.0, 0.7, 1.4));

}  // namespace
}  // namespace laparoscope_servo::tracking
