#include "features/spline_prior.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

namespace laparoscope_servo::features {
namespace {

TEST(SplinePrior, similarityIsTheOneThatThePointsWereMovedBy) {
  Spline::Points from, to;
  Eigen::Matrix2d linear;
  linear << 0.9, -0.3, 0.3, 0.9;
  constexpr std::size_t kSize = 12;
  for (std::size_t k = 0; k < kSize; ++k) {
    const double phi = 0.5 * static_cast<double>(k);
    from[k] = Eigen::Vector2d(100.0 + 40.0 * std::cos(phi), 90.0 + 25.0 * std::sin(1.3 * phi));
    to[k] = linear * from[k] + Eigen::Vector2d(3.0, -20.0);
  }
  const Similarity similarity(from, to, static_cast<int>(kSize));
  for (std::size_t k = 0; k < kSize; ++k) EXPECT_LT((similarity(from[k]) - to[k]).norm(), 1e-9);
  EXPECT_NEAR(similarity.scale(), std::hypot(0.9, 0.3), 1e-12);
}

TEST(SplinePrior, bendingIsStifferThanTheWhole) {
  const Spline::Matrix closed = stiffness(12, true, {0.5, 2.0});
  // All by the same: no bend. Every other one the other way: nothing but bend.
  const Eigen::VectorXd all = Eigen::VectorXd::Ones(12);
  Eigen::VectorXd zigzag(12);
  for (int k = 0; k < 12; ++k) zigzag[k] = k % 2 == 0 ? 1.0 : -1.0;
  EXPECT_NEAR(all.dot(closed * all), 12.0 / 4.0, 1e-9);
  EXPECT_NEAR(zigzag.dot(closed * zigzag), 12.0 / 4.0 + 12.0 * 4.0 / 0.25, 1e-9);
  const Spline::Matrix open = stiffness(12, false, {0.5, 2.0});
  EXPECT_NEAR(zigzag.dot(open * zigzag), 12.0 / 4.0 + 10.0 * 4.0 / 0.25, 1e-9);
}

// A contour that deforms as a whole, and one that bends: both are known as well everywhere along a closed one.
TEST(SplinePrior, AClosedContourHasNoFirstPoint) {
  const Spline::Matrix closed = stiffness(10, true, {0.7, 3.0});
  for (int k = 0; k < 10; ++k) {
    for (int l = 0; l < 10; ++l) EXPECT_NEAR(closed(k, l), closed((k + 1) % 10, (l + 1) % 10), 1e-12);
  }
  EXPECT_NEAR((closed - closed.transpose()).norm(), 0.0, 1e-12);
}

// The ends of an open contour have one neighbour less, and so less that holds them.
TEST(SplinePrior, TheEndsOfAnOpenContourAreLessKnown) {
  const Eigen::MatrixXd covariance = Eigen::MatrixXd(stiffness(10, false, {0.7, 3.0})).inverse();
  for (int k = 1; k < 9; ++k) EXPECT_LT(covariance(k, k), covariance(0, 0)) << k;
  EXPECT_NEAR(covariance(0, 0), covariance(9, 9), 1e-9);
  EXPECT_LT(covariance(0, 0), 9.0) << "no less known than by the whole alone";
}

TEST(SplinePrior, IsAnInverseCovariance) {
  for (const bool is_closed : {false, true}) {
    const Spline::Matrix matrix = stiffness(Spline::kMostPoints, is_closed, {0.1, 5.0});
    EXPECT_GT(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(matrix).eigenvalues()[0], 0.99 / 25.0);
  }
}

// What no similarity does is told by the nearest one: least squares leave no similarity in what is left.
TEST(SplinePrior, TheSimilarityIsTheNearestOne) {
  Spline::Points from, to;
  constexpr int kSize = 8;
  for (int k = 0; k < kSize; ++k) {
    const double phi = 2.0 * M_PI * k / kSize;
    from[static_cast<std::size_t>(k)] = Eigen::Vector2d(50.0 + 30.0 * std::cos(phi), 80.0 + 12.0 * std::sin(phi));
    to[static_cast<std::size_t>(k)] = Eigen::Vector2d(20.0 + 33.0 * std::cos(phi), 70.0 + 6.0 * std::sin(2.0 * phi));
  }
  const Similarity found(from, to, kSize);
  const auto squares = [&](const Eigen::Matrix2d& linear, const Eigen::Vector2d& translation) {
    double sum = 0.0;
    for (std::size_t k = 0; k < kSize; ++k) sum += (linear * from[k] + translation - to[k]).squaredNorm();
    return sum;
  };
  const double least = squares(found.linear, found.translation);
  for (const double step : {-1e-3, 1e-3}) {
    Eigen::Matrix2d turn;
    turn << 1.0, -step, step, 1.0;
    EXPECT_GT(squares(turn * found.linear, found.translation), least);
    EXPECT_GT(squares((1.0 + step) * found.linear, found.translation), least);
    EXPECT_GT(squares(found.linear, found.translation + Eigen::Vector2d(step, 0.0)), least);
    EXPECT_GT(squares(found.linear, found.translation + Eigen::Vector2d(0.0, step)), least);
  }
}

TEST(SplinePrior, modesAreFreedByTheirDeviationAndNothingElse) {
  constexpr int kSize = 12;
  Modes modes(kSize, 4);
  for (int k = 0; k < kSize; ++k) {
    const double angle = 2.0 * M_PI * k / kSize;
    modes.row(k) << std::cos(angle), std::sin(angle), 1.0, 0.2 * std::cos(2.0 * angle);
  }
  for (const bool closed : {true, false}) {
    const Eigen::MatrixXd stiff = stiffness(kSize, closed, {0.3, 0.8});
    const Eigen::MatrixXd variance = stiff.inverse() + 50.0 * 50.0 * modes * modes.transpose();
    const Eigen::MatrixXd found = freed(stiff, modes, 50.0);
    EXPECT_LT((found * variance - Eigen::MatrixXd::Identity(kSize, kSize)).norm(), 1e-6) << closed;
    EXPECT_LT((found - found.transpose()).norm(), 1e-12);
  }
}

// Only so many points count, and points that lie together have a radius all the same: a change is a share of it.
TEST(SplinePrior, TheExtentIsOfItsPointsAndNeverZero) {
  Spline::Points points;
  points.fill(Eigen::Vector2d(1e6, 1e6));
  points[0] = Eigen::Vector2d(10.0, 5.0);
  points[1] = Eigen::Vector2d(16.0, 13.0);
  const Extent two(points, 2);
  EXPECT_LT((two.centre - Eigen::Vector2d(13.0, 9.0)).norm(), 1e-12);
  EXPECT_NEAR(two.radius, 5.0, 1e-12);
  EXPECT_EQ(Extent(points, 1).radius, 1.0);
}

}  // namespace
}  // namespace laparoscope_servo::features
