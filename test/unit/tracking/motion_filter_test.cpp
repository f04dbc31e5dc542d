#include "tracking/motion_filter.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>

#include "support/synthetic_tissue.h"
#include "tracking/align/region_aligner.h"

namespace laparoscope_servo::tracking {
namespace {

const geometry::Rectangle kRoi = {90, 70, 101, 91};
constexpr double kHalfSize = 50.5;

Eigen::Matrix3d shift(double x, double y) {
  Eigen::Matrix3d g = Eigen::Matrix3d::Identity();
  g.topRightCorner<2, 1>() << x, y;
  return g;
}

class MotionFilterTest : public ::testing::Test {
 protected:
  MotionFilter filter_{0.8};
  double now_ = 0.0;

  void SetUp() override {
    Eigen::Matrix3d n = Eigen::Matrix3d::Identity();
    n(0, 0) = n(1, 1) = 1.0 / kHalfSize;
    n.topRightCorner<2, 1>() = -kRoi.centre() / kHalfSize;
    filter_.start(kRoi, n, now_);
  }
  static EsmResult seen(const Eigen::Matrix3d& g, double px = 0.05) {
    EsmResult estimate;
    estimate.state.g = g;
    estimate.covariance = Matrix8d::Identity() * std::pow(px / kHalfSize, 2);
    estimate.noise = 9.0;
    return estimate;
  }
  MotionPrior next(const Eigen::Matrix3d& g, bool learn = true) {
    now_ += 0.04;
    const MotionPrior prior = filter_.predict(now_);
    filter_.update(prior, seen(g), now_, learn);
    return prior;
  }
  // px, standard deviation of a coordinate x_k
  static double spread(const MotionPrior& prior, int k) {
    return kHalfSize * std::sqrt(prior.information.inverse()(k, k));
  }
};

TEST_F(MotionFilterTest, StartsAtTheReference) {
  EXPECT_TRUE(filter_.last().isIdentity());
  EXPECT_TRUE(filter_.predict(0.04).predicted.isIdentity(1e-12));
}

TEST_F(MotionFilterTest, GoesOnByTheDampedLastMotion) {
  next(shift(3.0, -1.0));
  const Eigen::Matrix3d expected = filter_.predict(now_ + 0.04).predicted;
  EXPECT_LT(geometry::cornerDistance(expected, shift(3.0 + 0.8 * 3.0, -1.8), kRoi), 1e-6);
  EXPECT_LT(geometry::cornerDistance(filter_.predict(now_ + 0.08).predicted, shift(3.0 + 1.6 * 3.0, -2.6), kRoi), 1e-6);
  EXPECT_LT(geometry::cornerDistance(filter_.predict(now_ - 1.0).predicted, shift(3.0, -1.0), kRoi),
            1e-6);  // time does not run back
}

TEST_F(MotionFilterTest, StopsWhenTheRegionIsNotSeen) {
  next(shift(3.0, -1.0));
  filter_.stop();
  EXPECT_LT(geometry::cornerDistance(filter_.predict(now_ + 0.04).predicted, shift(3.0, -1.0), kRoi), 1e-9);
}

TEST_F(MotionFilterTest, IsSurerOfATargetThatIsAsExpected) {
  const double before = spread(filter_.predict(0.04), 0);
  for (int k = 0; k < 100; ++k) next(Eigen::Matrix3d::Identity());
  const MotionPrior still = filter_.predict(now_ + 0.04);
  EXPECT_LT(spread(still, 0), 0.3 * before);
  EXPECT_GT(spread(still, 0), 0.4);  // but it may begin to move
  EXPECT_NEAR(still.noise, 9.0, 3.0);
}

// What moves along x only stays known along y.
TEST_F(MotionFilterTest, LearnsWhichWayTheTargetMoves) {
  cv::RNG rng(3);
  for (int k = 0; k < 200; ++k) next(shift(rng.gaussian(5.0), 0.0));
  const MotionPrior prior = filter_.predict(now_ + 0.04);
  EXPECT_GT(spread(prior, 0), 3.0);
  EXPECT_LT(spread(prior, 1), 1.0);
  EXPECT_LT(spread(prior, 6), 1.0);
}

TEST_F(MotionFilterTest, LearnsNothingFromWhatIsHardlySeen) {
  const double before = spread(filter_.predict(0.04), 0);
  for (int k = 0; k < 50; ++k) next(Eigen::Matrix3d::Identity(), false);
  EXPECT_NEAR(spread(filter_.predict(now_ + 0.04), 0), before, 0.1 * before);
}

TEST_F(MotionFilterTest, IsLessSureAfterImagesThatWereMissed) {
  for (int k = 0; k < 20; ++k) next(Eigen::Matrix3d::Identity());
  const double soon = spread(filter_.predict(now_ + 0.04), 0);
  EXPECT_GT(spread(filter_.predict(now_ + 0.2), 0), 3.0 * soon);
  EXPECT_LT(spread(filter_.predict(now_ + 1e9), 0), 20.0 * soon);
}

TEST_F(MotionFilterTest, RestartsWithoutAVelocity) {
  next(shift(3.0, -1.0));
  filter_.restart(seen(shift(40.0, 0.0)), 1.0);
  EXPECT_LT(geometry::cornerDistance(filter_.predict(1.04).predicted, shift(40.0, 0.0), kRoi), 1e-9);
  EXPECT_EQ(filter_.lastStamp(), 1.0);
}

// What the filter is for: of a region that moves as a whole only one end is seen; the other end follows, and is known
// to be less certain.
TEST_F(MotionFilterTest, TheCoveredPartFollowsWhatIsSeen) {
  const cv::Mat scene = test::tissue(cv::Size(300, 240), 5);
  const auto pyramidOf = [](const cv::Mat& image) {
    image::RegionPyramid pyramid;
    pyramid.build(image, cv::Rect(0, 0, image.cols, image.rows), 3, image::kLuma);
    return pyramid;
  };
  Esm esm{EsmConfig()};
  esm.setReference(pyramidOf(scene), kRoi);
  filter_.start(kRoi, esm.normalisation(), 0.0);
  now_ = 0.0;
  cv::RNG rng(4);
  Eigen::Matrix3d g = Eigen::Matrix3d::Identity();
  for (int k = 0; k < 60; ++k) {
    g = shift(rng.uniform(-2.0, 2.0), rng.uniform(-2.0, 2.0)) * g;
    next(g);
  }
  cv::Mat1f weights = cv::Mat1f::zeros(91, 101);
  weights(cv::Rect(0, 0, 24, 91)).setTo(1.0f);
  esm.setWeights(weights);
  const Eigen::Matrix3d truth = shift(2.0, -1.5) * g;
  double with = 0.0, without = 0.0, expected = 0.0;
  for (int trial = 0; trial < 20; ++trial) {
    const image::RegionPyramid image = pyramidOf(test::view(scene, truth, 1.0, 0.0, 4.0, 20 + trial));
    const MotionPrior prior = filter_.predict(now_ + 0.04);
    EsmState start;
    start.g = prior.predicted;
    esm.forgetLight();
    const EsmResult known = esm.align(image, start, &prior);
    esm.forgetLight();
    const EsmResult alone = esm.align(image, start);
    with += geometry::cornerDistance(known.state.g, truth, kRoi) / 20.0;
    without += geometry::cornerDistance(alone.state.g, truth, kRoi) / 20.0;
    expected += known.corner_error / 20.0;
  }
  EXPECT_LT(with, 0.7 * without);
  EXPECT_GT(expected, 0.4 * with);
  EXPECT_LT(expected, 4.0 * with);
}

}  // namespace
}  // namespace laparoscope_servo::tracking
