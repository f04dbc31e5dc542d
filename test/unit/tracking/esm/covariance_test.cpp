#include "tracking/esm/covariance.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "laparoscope_servo/geometry/sl3.h"

namespace laparoscope_servo::tracking {
namespace {

const geometry::Rectangle kRoi = {100, 80, 120, 60};
constexpr double kSigma = 3.0;

// Equations of `count` blocks of a few random pixels each, whose residuals are noise, of the pixel alone or of the
// block.
struct Equations {
  Matrix10d matrix = Matrix10d::Zero();
  std::vector<LightBlockSums> blocks;
};

Equations randomEquations(int count, double of_pixel, double of_block, unsigned seed = 1) {
  std::mt19937 generator(seed);
  std::normal_distribution<double> normal;
  Equations result;
  for (int k = 0; k < count; ++k) {
    LightBlockSums sums{0.0, 0.0, Vector10d::Zero(), Vector10d::Zero()};
    const double common = of_block * normal(generator);
    const Vector10d mean = Vector10d::NullaryExpr([&] { return normal(generator); });
    for (int i = 0; i < 20; ++i) {
      const Vector10d row = mean + Vector10d::NullaryExpr([&] { return normal(generator); });
      result.matrix += row * row.transpose();
      sums.weight += 1.0;
      sums.score += (of_pixel * normal(generator) + common) * row;
    }
    result.blocks.push_back(sums);
  }
  return result;
}

EstimateCovariance of(const Equations& e, const Matrix8d& prior = Matrix8d::Zero()) {
  return estimateCovariance(e.matrix, e.blocks, kSigma, prior);
}

TEST(EstimateCovariance, OfIndependentResidualsIsTheTextbooks) {
  const Equations e = randomEquations(400, kSigma, 0.0);
  const EstimateCovariance found = of(e);
  ASSERT_TRUE(found.covariance);
  EXPECT_GE(found.noise, kSigma * kSigma);
  EXPECT_LT(found.noise, 1.2 * kSigma * kSigma);
  const Matrix8d expected = *covarianceOfNoise(e.matrix, found.noise);
  EXPECT_TRUE(found.covariance->isApprox(expected, 1e-9));
  EXPECT_TRUE(expected.isApprox(found.noise * e.matrix.inverse().topLeftCorner<8, 8>(), 1e-9));
}

TEST(EstimateCovariance, ResidualsThatErrTogetherCountAsFewer) {
  const double alone = of(randomEquations(400, kSigma, 0.0)).noise;
  const double together = of(randomEquations(400, kSigma, kSigma)).noise;
  EXPECT_GT(together, 4.0 * alone);
}

// All the blocks that there are have been fitted to: their scatter shows less than there is.
TEST(EstimateCovariance, FewBlocksMakeLessSure) {
  const Equations e = randomEquations(12, kSigma, kSigma);
  Equations many = e;
  for (LightBlockSums& sums : many.blocks) sums.score /= std::sqrt(40.0);
  for (int k = 1; k < 40; ++k) many.blocks.insert(many.blocks.end(), many.blocks.begin(), many.blocks.begin() + 12);
  // The same sum of squares, from blocks of which nine are a large part or a small one.
  EXPECT_GT(of(e).noise, 3.0 * of(many).noise);
}

TEST(EstimateCovariance, BlocksWithoutWeightDoNotCount) {
  const Equations e = randomEquations(30, kSigma, kSigma);
  Equations more = e;
  for (int k = 0; k < 100; ++k) more.blocks.push_back({0.0, 0.0, Vector10d::Zero(), Vector10d::Constant(7.0)});
  EXPECT_EQ(of(e).noise, of(more).noise);
}

TEST(EstimateCovariance, APriorAddsItsInformation) {
  const Equations e = randomEquations(100, kSigma, 0.0);
  const Matrix8d prior = 50.0 * Matrix8d::Identity();
  const EstimateCovariance without = of(e);
  const EstimateCovariance with = of(e, prior);
  EXPECT_EQ(with.noise, without.noise);
  EXPECT_TRUE(with.covariance->inverse().isApprox(without.covariance->inverse() + prior, 1e-9));
}

TEST(EstimateCovariance, WithoutEquationsThereIsThePriorOrNothing) {
  const Equations none{Matrix10d::Zero(), {}};
  EXPECT_FALSE(of(none).covariance);
  EXPECT_FALSE(covarianceOfNoise(none.matrix, 4.0));
  const EstimateCovariance prior = of(none, 4.0 * Matrix8d::Identity());
  ASSERT_TRUE(prior.covariance);
  EXPECT_TRUE(prior.covariance->isApprox(0.25 * Matrix8d::Identity(), 1e-12));
}

// By drawing deviations: G' = G N^-1 exp(A(x)) N.
TEST(CornerError, IsTheSpreadOfTheWorstCornerAndThatOfTheCentreIsTheCentres) {
  std::mt19937 generator(3);
  std::normal_distribution<double> normal;
  Eigen::Matrix3d g;
  g << 1.3, -0.4, 20.0, 0.3, 1.1, -10.0, 4e-4, -2e-4, 1.0;
  const Matrix8d root = 1e-3 * Matrix8d::NullaryExpr([&] { return normal(generator); });
  const Eigen::Matrix3d n = templateFromPixels(kRoi);
  const geometry::Quadrilateral corners = geometry::apply(g, kRoi.corners());
  const Eigen::Vector2d middle(kRoi.x + 0.5 * (kRoi.width - 1.0), kRoi.y + 0.5 * (kRoi.height - 1.0));
  const Eigen::Vector2d centre = geometry::apply(g, middle);
  double squares[4] = {};
  double of_centre = 0.0;
  constexpr int kDraws = 4000;
  for (int k = 0; k < kDraws; ++k) {
    const geometry::Vector8d x = root * geometry::Vector8d::NullaryExpr([&] { return normal(generator); });
    const Eigen::Matrix3d deviated = g * n.inverse() * geometry::sl3Exp(x) * n;
    const geometry::Quadrilateral moved = geometry::apply(deviated, kRoi.corners());
    of_centre += (geometry::apply(deviated, middle) - centre).squaredNorm();
    for (int corner = 0; corner < 4; ++corner) squares[corner] += (moved[corner] - corners[corner]).squaredNorm();
  }
  const double spread = std::sqrt(*std::max_element(squares, squares + 4) / kDraws);
  EXPECT_NEAR(cornerError(g, kRoi, root * root.transpose()), spread, 0.05 * spread);
  const double of_middle = std::sqrt(of_centre / kDraws);
  EXPECT_NEAR(centreError(g, kRoi, root * root.transpose()), of_middle, 0.05 * of_middle);
}

// Not 0, which is what a maximum makes of NaN.
TEST(CornerError, IsInfiniteForWhatIsNoCovariance) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const Matrix8d& none : {Matrix8d(nan * Matrix8d::Identity()), Matrix8d(-Matrix8d::Identity())}) {
    EXPECT_EQ(cornerError(Eigen::Matrix3d::Identity(), kRoi, none), std::numeric_limits<double>::infinity());
    EXPECT_EQ(centreError(Eigen::Matrix3d::Identity(), kRoi, none), std::numeric_limits<double>::infinity());
  }
}

}  // namespace
}  // namespace laparoscope_servo::tracking
