#include "tracking/align/texture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <opencv2/imgproc.hpp>

#include "support/synthetic_tissue.h"

namespace laparoscope_servo::tracking {
namespace {

cv::Mat1f noise(const cv::Size& size, double sigma, unsigned seed) {
  cv::Mat1f plane(size);
  cv::RNG rng(seed);
  rng.fill(plane, cv::RNG::NORMAL, 100.0, sigma);
  return plane;
}

cv::Mat1f scene(const cv::Size& size) {
  cv::Mat1b green;
  cv::extractChannel(test::tissue(size, 5), green, 1);
  return green;
}

TEST(NoiseOf, IsTheStandardDeviationOfWhiteNoise) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    for (const double sigma : {0.5, 2.0, 8.0})
      EXPECT_NEAR(noiseOf(noise({120, 90}, sigma, seed)), sigma, 0.1 * sigma) << "seed " << seed;
  }
}

TEST(NoiseOf, OfAShadeIsNone) {
  cv::Mat1f ramp(80, 80);
  for (int j = 0; j < 80; ++j) {
    for (int i = 0; i < 80; ++i) ramp(j, i) = 10.0f + 1.5f * i + 0.5f * j + 0.01f * i * j;
  }
  EXPECT_NEAR(noiseOf(ramp), 0.0, 1e-3);
}

TEST(NoiseOf, OfTextureIsHardlyMoreThanThatOfTheNoiseInIt) {
  const cv::Mat1f clean = scene({160, 120});
  EXPECT_LT(noiseOf(clean), 1.0);
  cv::Mat1f noisy = noise(clean.size(), 4.0, 3);
  noisy += clean - 100.0f;
  EXPECT_NEAR(noiseOf(noisy), 4.0, 0.5);
}

TEST(NoiseOf, OfWhatTheMaskCoversDoesNotCount) {
  cv::Mat1f plane = noise({120, 90}, 2.0, 1);
  const cv::Rect black(0, 0, 50, 90);
  plane(black).setTo(0.0f);
  EXPECT_LT(noiseOf(plane), 0.5);
  cv::Mat mask = cv::Mat::zeros(plane.size(), CV_8UC1);
  mask(black).setTo(255);
  EXPECT_NEAR(noiseOf(plane, mask), 2.0, 0.3);
  mask.setTo(255);
  EXPECT_EQ(noiseOf(plane, mask), noiseOf(plane)) << "nothing else is seen";
}

TEST(NoiseOf, OfAFewPixelsIsNone) {
  EXPECT_EQ(noiseOf(cv::Mat1f(2, 50, 7.0f)), 0.0);
  EXPECT_EQ(noiseOf(cv::Mat1f(50, 2, 7.0f)), 0.0);
  EXPECT_EQ(noiseOf(cv::Mat1f(3, 3, 7.0f)), 0.0);
}

// Of white noise: a central difference has half its variance, and there are two.
double gradientOf(double sigma) {
  return sigma * sigma;
}

TEST(TextureShare, OfNoiseIsNoneWhateverItsStrength) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    for (const double sigma : {0.5, 2.0, 8.0}) {
      const cv::Mat1f plane = noise({120, 90}, sigma, seed);
      EXPECT_LT(cv::mean(textureShare(plane, gradientOf(noiseOf(plane))))[0], 0.002) << "seed " << seed;
    }
  }
}

TEST(TextureShare, OfTextureIsNearlyAllAndLessInNoise) {
  const cv::Mat1f clean = scene({160, 120});
  const double share = cv::mean(textureShare(clean, gradientOf(noiseOf(clean))))[0];
  EXPECT_GT(share, 0.95);
  cv::Mat1f noisy = noise(clean.size(), 4.0, 3);
  noisy += clean - 100.0f;
  EXPECT_LT(cv::mean(textureShare(noisy, gradientOf(noiseOf(noisy))))[0], share);
}

TEST(TextureShare, WithoutNoiseIsAllAndAlwaysWithinItsRange) {
  const cv::Mat1f flat(40, 40, 90.0f);
  EXPECT_EQ(cv::norm(textureShare(flat, 0.0), cv::Mat1f(40, 40, 1.0f), cv::NORM_INF), 0.0);
  EXPECT_EQ(cv::countNonZero(textureShare(flat, 1.0)), 0);
  double low = 0.0, high = 0.0;
  cv::minMaxLoc(textureShare(scene({80, 80}), 9.0), &low, &high);
  EXPECT_GE(low, 0.0);
  EXPECT_LE(high, 1.0);
}

}  // namespace
}  // namespace laparoscope_servo::tracking
