#include "laparoscope_servo/robust/irls.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace laparoscope_servo::robust {
namespace {

// y = 3 - 0.5 t at t in [-1, 1], with noise; `astray` of 100 rows lie up to 40 higher.
std::vector<Row> straightLine(int rows, double noise, int astray, unsigned seed = 1) {
  std::mt19937 random(seed);
  std::normal_distribution<double> grain(0.0, 1.0);
  std::uniform_real_distribution<double> far(5.0, 40.0);
  std::vector<Row> result;
  for (int i = 0; i < rows; ++i) {
    const double t = 2.0 * i / (rows - 1.0) - 1.0;
    Row row;
    row.count = 2;
    row.a = {1.0, t};
    row.b = 3.0 - 0.5 * t + noise * grain(random);
    if (i * 37 % 100 < astray) row.b += far(random);
    result.push_back(row);
  }
  return result;
}

TEST(Irls, solvesWhatIsExact) {
  Irls irls;
  IrlsConfig config;
  config.min_sigma = 1e-3;
  const IrlsResult result = irls.solve(2, straightLine(50, 0.0, 0), config);
  ASSERT_TRUE(result.solved);
  EXPECT_NEAR(irls.x()[0], 3.0, 1e-9);
  EXPECT_NEAR(irls.x()[1], -0.5, 1e-9);
  EXPECT_EQ(result.sigma, config.min_sigma);
}

TEST(Irls, findsTheLineWithFourOfTenRowsAstray) {
  Irls irls;
  const IrlsResult result = irls.solve(2, straightLine(200, 0.1, 40), {});
  ASSERT_TRUE(result.solved);
  EXPECT_NEAR(irls.x()[0], 3.0, 0.05);
  EXPECT_NEAR(irls.x()[1], -0.5, 0.08);
  int out = 0;
  for (const double weight : irls.weights()) out += weight < 0.01 ? 1 : 0;
  EXPECT_GE(out, 70);
  EXPECT_LE(out, 82);
}

TEST(Irls, huberBearsFewerAstrayButNeverTurnsAway) {
  Irls irls;
  IrlsConfig config;
  config.weights = Weights::kHuber;
  ASSERT_TRUE(irls.solve(2, straightLine(200, 0.1, 10), config).solved);
  EXPECT_NEAR(irls.x()[0], 3.0, 0.1);
  for (const double weight : irls.weights()) EXPECT_GT(weight, 0.0);
}

// Most rows tell of one unknown, and agree; few tell of the other one, whose rows look astray as long as it is 0.
TEST(Irls, aWideStartLetsFewRowsSayWhatOnlyTheyTell) {
  std::vector<Row> rows;
  for (int i = 0; i < 60; ++i) {
    Row row;
    row.first = i < 50 ? 0 : 1;
    row.count = 1;
    row.a = {1.0};
    row.b = i < 50 ? 0.0 : 2.0;
    rows.push_back(row);
  }
  const Eigen::MatrixXd information = 0.1 * Eigen::MatrixXd::Identity(2, 2);
  Irls irls;
  IrlsConfig config;
  config.min_sigma = 0.1;
  ASSERT_TRUE(irls.solve(2, rows, config, information).solved);
  EXPECT_NEAR(irls.x()[1], 0.0, 0.01);
  config.start_sigma = 1.0;
  const IrlsResult result = irls.solve(2, rows, config, information);
  ASSERT_TRUE(result.solved);
  EXPECT_NEAR(irls.x()[1], 2.0, 0.01);
  EXPECT_EQ(result.sigma, config.min_sigma);
}

TEST(Irls, rowsWithoutWeightTakeNoPart) {
  std::vector<Row> rows = straightLine(50, 0.0, 0);
  for (std::size_t i = 0; i < rows.size(); i += 2) {
    rows[i].weight = 0.0;
    rows[i].b = 1e6;
  }
  Irls irls;
  IrlsConfig config;
  config.min_sigma = 1e-3;
  ASSERT_TRUE(irls.solve(2, rows, config).solved);
  EXPECT_NEAR(irls.x()[0], 3.0, 1e-9);
}

// The spread of what is estimated, over many draws, is what the covariance says.
TEST(Irls, covarianceSaysHowFarItIsOff) {
  constexpr int kDraws = 400;
  Irls irls;
  double squares = 0.0, expected = 0.0;
  for (unsigned seed = 1; seed <= kDraws; ++seed) {
    ASSERT_TRUE(irls.solve(2, straightLine(60, 0.2, 0, seed), {}).solved);
    squares += std::pow(irls.x()[1] + 0.5, 2);
    expected += irls.covariance()(1, 1);
  }
  EXPECT_NEAR(std::sqrt(squares / expected), 1.0, 0.15);
}

TEST(Irls, whatIsKnownBeforehandHoldsWhatRowsLeaveOpen) {
  std::vector<Row> rows = straightLine(20, 0.0, 0);
  for (Row& row : rows) row.count = 1;  // of three unknowns these see the first
  for (Row& row : rows) row.b = 3.0;
  Irls irls;
  IrlsConfig config;
  config.min_sigma = 0.1;
  EXPECT_FALSE(irls.solve(3, rows, config).solved);
  const Eigen::MatrixXd information = 1e-6 * Eigen::MatrixXd::Identity(3, 3);
  ASSERT_TRUE(irls.solve(3, rows, config, information).solved);
  EXPECT_NEAR(irls.x()[0], 3.0, 1e-6);
  EXPECT_EQ(irls.x()[1], 0.0);
  EXPECT_NEAR(irls.covariance()(1, 1), 1e6, 1.0);
}

// One row that says 4, as good as what was expected, which is 2: the middle.
TEST(Irls, rowsAndWhatWasExpectedAreWeighed) {
  std::vector<Row> rows(1);
  rows[0].count = 1;
  rows[0].a = {1.0};
  rows[0].b = 4.0;
  Irls irls;
  IrlsConfig config;
  config.min_sigma = 0.1;
  const Eigen::MatrixXd information = Eigen::MatrixXd::Constant(1, 1, 100.0);
  ASSERT_TRUE(irls.solve(1, rows, config, information, Eigen::VectorXd::Constant(1, 2.0)).solved);
  EXPECT_NEAR(irls.x()[0], 3.0, 1e-9);
  EXPECT_NEAR(irls.covariance()(0, 0), 0.005, 1e-9);
}

// Coefficients that go on at the first column: as if they had been written there.
TEST(Irls, rowsGoRound) {
  std::vector<Row> round = straightLine(40, 0.1, 0), straight = round;
  for (Row& row : round) {
    row.first = 1;
    row.a = {row.a[1], row.a[0]};
  }
  Irls a, b;
  ASSERT_TRUE(a.solve(2, round, {}).solved);
  ASSERT_TRUE(b.solve(2, straight, {}).solved);
  EXPECT_NEAR((a.x() - b.x()).norm(), 0.0, 1e-12);
  EXPECT_NEAR((a.covariance() - b.covariance()).norm(), 0.0, 1e-12);
}

TEST(Irls, refusesTooFewRowsAndWhatIsNotFinite) {
  Irls irls;
  EXPECT_FALSE(irls.solve(2, {}, {}).solved);
  IrlsConfig config;
  config.min_sigma = 0.1;
  EXPECT_FALSE(irls.solve(2, {straightLine(20, 0.0, 0)[3]}, config).solved);
  std::vector<Row> rows = straightLine(20, 0.0, 0);
  rows[3].a[1] = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(irls.solve(2, rows, config).solved);
  EXPECT_TRUE(irls.x().isZero());
}

}  // namespace
}  // namespace laparoscope_servo::robust
