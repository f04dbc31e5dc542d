#include "features/points/agreement.h"

#include <gtest/gtest.h>

#include <vector>

#include "seen.h"
#include "support/synthetic_tissue.h"

namespace laparoscope_servo::features {
namespace {

constexpr int kHalf = 10;
const Eigen::Vector2d kPlace(100.0, 80.0);

Window window(const cv::Mat& picture) {
  Window result(kHalf);
  result.sample(seen(picture), 0, kPlace, Eigen::Matrix2d::Identity());
  return result;
}

double share(const cv::Mat& then, const cv::Mat& now) {
  const Window view = window(then), seen = window(now);
  std::vector<float> residuals(static_cast<std::size_t>(view.count()));
  for (std::size_t k = 0; k < residuals.size(); ++k) residuals[k] = seen.values()[k] - view.values()[k];
  return agreeingShare(view, seen, residuals);
}

cv::Mat tissue(unsigned seed) {
  return test::tissue({200, 160}, seed);
}

TEST(Agreement, OfTheSameTextureIsWholeAndOfAnotherLittle) {
  EXPECT_EQ(share(tissue(5), tissue(5)), 1.0);
  EXPECT_GT(share(tissue(5), test::view(tissue(5), Eigen::Matrix3d::Identity(), 1.0, 0.0, 2.0)), 0.9);
  EXPECT_LT(share(tissue(5), tissue(6)), 0.3);
}

TEST(Agreement, OfHalfACoverIsHalf) {
  cv::Mat covered = tissue(5);
  covered.colRange(0, 100).setTo(cv::Scalar::all(90));
  EXPECT_NEAR(share(tissue(5), covered), 0.5, 0.2);
}

// A flat instrument beside tissue that has moved on: the instrument's half, and its strong edge, do not make up for it.
TEST(Agreement, FlatPartsHaveNoSay) {
  cv::Mat then = tissue(5), now = tissue(6);
  for (cv::Mat* picture : {&then, &now}) picture->colRange(0, 100).setTo(cv::Scalar::all(40));
  EXPECT_LT(share(then, now), 0.5);
  EXPECT_EQ(share(then, then), 1.0);
}

TEST(Agreement, NorHasWhatIsSaturatedOrFlatAltogether) {
  cv::Mat bright = tissue(5);
  bright.colRange(0, 100).setTo(cv::Scalar::all(255));
  EXPECT_EQ(share(tissue(5), bright), 1.0);
  const cv::Mat flat(160, 200, CV_8UC1, cv::Scalar(90));
  EXPECT_EQ(share(flat, flat), 0.0);
}

}  // namespace
}  // namespace laparoscope_servo::features
