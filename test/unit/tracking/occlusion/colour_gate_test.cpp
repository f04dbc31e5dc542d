#include "tracking/occlusion/colour_gate.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/synthetic_tissue.h"

namespace laparoscope_servo::tracking {
namespace {

// Eq. (5) as it is printed, in double precision.
double published(double r, double g, double b) {
  const double s0 = std::max({r, g, b}) - std::min({r, g, b});
  const double h = std::acos(0.5 * ((r - g) + (r - b)) / std::sqrt((r - g) * (r - g) + (r - b) * (g - b)));
  return s0 * std::cos(h);
}

TEST(HueSaturationFeature, IsThePublishedOneWhereThatIsDefined) {
  cv::RNG rng(1);
  for (int k = 0; k < 2000; ++k) {
    const int r = rng.uniform(0, 256), g = rng.uniform(0, 256), b = rng.uniform(0, 256);
    if (r == g && g == b) continue;
    const double expected = published(r, g, b);
    if (std::isnan(expected)) continue;  // acos of 1 + rounding
    EXPECT_NEAR(hueSaturationFeature(r, g, b), expected, 1e-3) << r << ' ' << g << ' ' << b;
  }
}

TEST(HueSaturationFeature, HasItsExtremesAtRedAndCyanAndIsZeroForGrey) {
  EXPECT_FLOAT_EQ(hueSaturationFeature(255, 0, 0), 255.0f);
  EXPECT_FLOAT_EQ(hueSaturationFeature(0, 255, 255), -255.0f);
  for (int grey : {0, 1, 128, 255}) EXPECT_EQ(hueSaturationFeature(grey, grey, grey), 0.0f);
  // S0 does not change along the grey axis (Hanbury and Serra), and so neither does the feature.
  EXPECT_FLOAT_EQ(hueSaturationFeature(120, 60, 30), hueSaturationFeature(220, 160, 130));
}

TEST(NormalisedFeature, BearsAChangeOfBrightnessThatThePublishedOneDoesNot) {
  const float reference = normalisedFeature(150, 80, 70);
  EXPECT_NEAR(normalisedFeature(0.8f * 150, 0.8f * 80, 0.8f * 70) / reference, 1.0, 0.05);
  EXPECT_NEAR(normalisedFeature(1.25f * 150, 1.25f * 80, 1.25f * 70) / reference, 1.0, 0.05);
  EXPECT_NEAR(hueSaturationFeature(0.8f * 150, 0.8f * 80, 0.8f * 70) / hueSaturationFeature(150, 80, 70), 0.8, 1e-3);
  EXPECT_LE(normalisedFeature(255, 0, 0), 3.0f);
  EXPECT_GE(normalisedFeature(0, 255, 255), -1.5f);
}

TEST(BhattacharyyaDistance, IsAMetricsZeroAndOne) {
  const float a[] = {0.5f, 0.5f, 0.0f, 0.0f};
  const float b[] = {0.0f, 0.0f, 0.25f, 0.75f};
  const float c[] = {0.4f, 0.3f, 0.2f, 0.1f};
  EXPECT_NEAR(bhattacharyyaDistance(a, a, 4), 0.0f, 1e-3);
  EXPECT_FLOAT_EQ(bhattacharyyaDistance(a, b, 4), 1.0f);
  EXPECT_FLOAT_EQ(bhattacharyyaDistance(a, c, 4), bhattacharyyaDistance(c, a, 4));
  EXPECT_LE(bhattacharyyaDistance(a, b, 4), bhattacharyyaDistance(a, c, 4) + bhattacharyyaDistance(c, b, 4));
}

struct Compared {
  std::vector<float> distance;
  image::AreaGrid grid;
};

Compared compare(ColourGate mode, const cv::Mat& reference, const cv::Mat& current, const cv::Mat1b& valid) {
  Compared result;
  result.grid = image::AreaGrid(reference.cols, reference.rows, 14, 14);
  ColourHistograms a(mode, 32), b(mode, 32);
  image::ColourPatch patch;
  image::warpNearest(reference, Eigen::Matrix3d::Identity(), reference.size(), patch);
  a.compute(patch, result.grid);
  image::warpNearest(current, Eigen::Matrix3d::Identity(), current.size(), patch);
  patch.valid &= valid;
  b.compute(patch, result.grid);
  for (int area = 0; area < result.grid.count(); ++area) {
    float sum = 0.0f;
    for (int l = 0; l < 32; ++l) sum += a.histogram(area)[l];
    EXPECT_NEAR(sum, 1.0f, 1e-5);  // eq. (1)
  }
  areaDistances(a, b, result.grid, 32, result.distance);
  return result;
}

TEST(ColourHistograms, TellAnOccluderFromTissueInBothModes) {
  const cv::Mat reference = test::view(test::tissue(cv::Size(196, 196), 2), Eigen::Matrix3d::Identity(), 1, 0, 2.0, 5);
  cv::Mat current = test::view(test::tissue(cv::Size(196, 196), 2), Eigen::Matrix3d::Identity(), 1, 0, 2.0, 6);
  current(cv::Rect(0, 0, 98, 196)).setTo(cv::Scalar(190, 190, 190));
  for (ColourGate mode : {ColourGate::kPublished, ColourGate::kNormalised}) {
    const Compared c = compare(mode, reference, current, cv::Mat1b(reference.size(), 255));
    for (int area = 0; area < c.grid.count(); ++area) {
      if (area % 14 < 7) {
        EXPECT_GT(c.distance[area], 0.5f);
      } else {
        EXPECT_LT(c.distance[area], 0.5f);
      }
    }
  }
}

TEST(ColourHistograms, TheNormalisedModeKeepsCleanAreasWhenTheLightChanges) {
  const cv::Mat scene = test::tissue(cv::Size(196, 196), 2);
  const cv::Mat reference = test::view(scene, Eigen::Matrix3d::Identity(), 1, 0, 2.0, 5);
  for (double gain : {0.8, 1.25}) {
    const cv::Mat current = test::view(scene, Eigen::Matrix3d::Identity(), gain, 0, 2.0, 6);
    int rejected[2] = {0, 0};
    for (int k = 0; k < 2; ++k) {
      const Compared c = compare(k == 0 ? ColourGate::kPublished : ColourGate::kNormalised, reference, current,
                                 cv::Mat1b(reference.size(), 255));
      for (float d : c.distance) rejected[k] += d > 0.5f;
    }
    EXPECT_LE(rejected[1], 6) << "gain " << gain;  // 3 % of 196
    EXPECT_LE(rejected[1], rejected[0]);
  }
}

TEST(AreaDistances, AreNotANumberWhereTooLittleCanBeCompared) {
  const cv::Mat patch = test::tissue(cv::Size(140, 140), 2);
  cv::Mat1b valid(patch.size(), 255);
  valid(cv::Rect(0, 0, 10, 10)).setTo(0);  // all of area 0
  valid(cv::Rect(10, 0, 4, 10)).setTo(0);  // less than half of area 1
  const Compared c = compare(ColourGate::kPublished, patch, patch, valid);
  EXPECT_TRUE(std::isnan(c.distance[0]));
  EXPECT_LT(c.distance[1], 0.5f);
  EXPECT_NEAR(c.distance[2], 0.0f, 1e-3);
}

}  // namespace
}  // namespace laparoscope_servo::tracking
