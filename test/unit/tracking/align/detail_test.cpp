#include "tracking/align/detail.h"

#include <gtest/gtest.h>

#include "support/synthetic_tissue.h"

namespace laparoscope_servo::tracking {
namespace {

const cv::Size kSize(96, 80);

cv::Mat1f grey(unsigned seed) {
  cv::Mat mono;
  cv::cvtColor(test::tissue(kSize, seed), mono, cv::COLOR_BGR2GRAY);
  cv::Mat1f result;
  mono.convertTo(result, CV_32F);
  return result;
}

// Light that falls off from left to right.
cv::Mat1f shading() {
  cv::Mat1f result(kSize);
  for (int j = 0; j < kSize.height; ++j) {
    for (int i = 0; i < kSize.width; ++i) result(j, i) = 2.0f * static_cast<float>(i);
  }
  return result;
}

const cv::Mat1f kAll(kSize, 1.0f);

TEST(DetailCorrelation, TheSameTissueCorrelatesWhateverTheLight) {
  const cv::Mat1f a = grey(1);
  EXPECT_NEAR(detailCorrelation(a, a, kAll), 1.0, 1e-9);
  const cv::Mat1f brighter = 1.5f * a + 20.0f;
  EXPECT_NEAR(detailCorrelation(a, brighter, kAll), 1.0, 1e-6);
  EXPECT_NEAR(detailCorrelation(a, -a, kAll), -1.0, 1e-6);
  cv::Mat1f noise(kSize);
  cv::theRNG().state = 7;
  cv::randn(noise, 0.0, 2.0);
  EXPECT_GT(detailCorrelation(a, cv::Mat1f(a + 0.3f * shading() + noise), kAll), 0.9);
}

TEST(DetailCorrelation, SharedShadingDoesNotMakeOtherTissueTheSame) {
  const cv::Mat1f a = grey(1) + shading();
  const cv::Mat1f b = grey(2) + shading();
  EXPECT_LT(detailCorrelation(a, b, kAll), 0.4);
}

TEST(DetailCorrelation, OnlyWeightedPixelsCount) {
  const cv::Mat1f a = grey(1);
  cv::Mat1f b = a.clone();
  b(cv::Rect(0, 0, 48, 80)) = 3.0f * grey(2)(cv::Rect(0, 0, 48, 80));
  cv::Mat1f right = kAll.clone();
  right(cv::Rect(0, 0, 56, 80)) = 0.0f;
  EXPECT_NEAR(detailCorrelation(a, b, right), 1.0, 1e-6);
  EXPECT_LT(detailCorrelation(a, b, kAll), 0.8);
}

TEST(DetailCorrelation, IsZeroWhereNothingCanBeCompared) {
  const cv::Mat1f a = grey(1);
  EXPECT_EQ(detailCorrelation(a, a, cv::Mat1f(kSize, 0.0f)), 0.0);
  EXPECT_EQ(detailCorrelation(a, cv::Mat1f(kSize, 50.0f), kAll), 0.0);
}

}  // namespace
}  // namespace laparoscope_servo::tracking
