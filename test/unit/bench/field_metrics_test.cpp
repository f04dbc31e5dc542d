#include "bench/support/field_metrics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

using namespace laparoscope_servo;
using namespace laparoscope_servo::bench;

namespace {

const double kInfinity = std::numeric_limits<double>::infinity();

Eigen::Matrix3d shift(double x, double y) {
  Eigen::Matrix3d m = Eigen::Matrix3d::Identity();
  m(0, 2) = x;
  m(1, 2) = y;
  return m;
}

}  // namespace

TEST(RegionPoints, AreTheCentresOfTheAreasRowByRow) {
  const std::vector<Eigen::Vector2d> points = regionPoints({10.0, 20.0, 28.0, 42.0});
  ASSERT_EQ(points.size(), 196u);
  EXPECT_TRUE(points.front().isApprox(Eigen::Vector2d(10.5, 21.0)));  // of 2 x 3 px, whose centres are 10, 11; 20 .. 22
  EXPECT_TRUE(points[1].isApprox(Eigen::Vector2d(12.5, 21.0)));
  EXPECT_TRUE(points[14].isApprox(Eigen::Vector2d(10.5, 24.0)));
  EXPECT_TRUE(points.back().isApprox(Eigen::Vector2d(36.5, 60.0)));
}

TEST(Distances, AreInPixelsOfTheImageWhateverTheScaleOfTheHomography) {
  const std::vector<double> d = distances(2.5 * shift(5.0, 4.0), shift(2.0, 0.0), {{0.0, 0.0}, {100.0, 50.0}});
  ASSERT_EQ(d.size(), 2u);
  EXPECT_NEAR(d[0], 5.0, 1e-12);
  EXPECT_NEAR(d[1], 5.0, 1e-12);
}

TEST(Distances, AreInfiniteThroughInfinity) {
  Eigen::Matrix3d g = Eigen::Matrix3d::Identity();
  g(2, 0) = -0.01;  // the line x = 100 goes to infinity
  const std::vector<double> d = distances(g, Eigen::Matrix3d::Identity(), {{0.0, 0.0}, {100.0, 0.0}, {200.0, 0.0}});
  EXPECT_EQ(d[0], 0.0);
  EXPECT_EQ(d[1], kInfinity);
  EXPECT_EQ(d[2], kInfinity);
}

TEST(VisiblePoints, LieInTheImageAndInAreasOfWhichLessThanHalfIsCovered) {
  const std::vector<Eigen::Vector2d> points = {{0.0, 0.0}, {50.0, 10.0}, {50.0, 10.0}, {99.0, 49.0}};
  const cv::Size size(100, 50);
  EXPECT_EQ(visiblePoints(shift(0.0, 0.0), points, {}, size), std::vector<char>({1, 1, 1, 1}));
  EXPECT_EQ(visiblePoints(shift(0.0, 0.0), points, {0.49, 0.5, 1.0, 0.0}, size), std::vector<char>({1, 0, 0, 1}));
  EXPECT_EQ(visiblePoints(shift(0.5, 0.0), points, {}, size), std::vector<char>({1, 1, 1, 0}));
  EXPECT_EQ(visiblePoints(shift(0.0, -0.5), points, {}, size), std::vector<char>({0, 1, 1, 1}));
}

TEST(VisiblePoints, WantAShareForEachPoint) {
  EXPECT_THROW(visiblePoints(shift(0.0, 0.0), {{0.0, 0.0}, {1.0, 0.0}}, {0.0}, {10, 10}), std::invalid_argument);
}

TEST(PointScores, OfAPerfectTrackerAreOne) {
  PointScores scores;
  scores.add({0.0, 1.99}, {1, 1}, true);
  EXPECT_DOUBLE_EQ(scores.averageJaccard(), 1.0);
  EXPECT_DOUBLE_EQ(scores.averageAccuracy(), 1.0);
  EXPECT_DOUBLE_EQ(scores.averageClaimedAccuracy(), 1.0);
}

TEST(PointScores, AreMeansOverTheThresholds) {
  PointScores scores;
  scores.add({10.0}, {1}, true);  // within 16 and 32 px, not within 2, 4, 8
  EXPECT_DOUBLE_EQ(scores.averageAccuracy(), 0.4);
  EXPECT_DOUBLE_EQ(scores.averageJaccard(), 0.4);
}

TEST(PointScores, APointAtTheThresholdIsNotWithinIt) {
  PointScores scores;
  scores.add({32.0}, {1}, true);
  EXPECT_DOUBLE_EQ(scores.averageAccuracy(), 0.0);
}

TEST(PointScores, AWrongClaimCountsAsFalseBesideTheVisiblePointThatItMissed) {
  PointScores scores;
  scores.add({0.0, 100.0}, {1, 1}, true);  // 1 right of 2 visible ones, 1 false: 1 / (2 + 1)
  EXPECT_DOUBLE_EQ(scores.averageJaccard(), 1.0 / 3.0);
  EXPECT_DOUBLE_EQ(scores.averageAccuracy(), 0.5);
}

TEST(PointScores, AClaimOfACoveredPointIsFalseWhereverItIs) {
  PointScores scores;
  scores.add({0.0, 0.0}, {1, 0}, true);  // 1 / (1 + 1)
  EXPECT_DOUBLE_EQ(scores.averageJaccard(), 0.5);
  EXPECT_DOUBLE_EQ(scores.averageAccuracy(), 1.0);
}

TEST(PointScores, WhatIsNotClaimedIsMissedAndNotFalse) {
  PointScores scores;
  scores.add({0.0, 0.0}, {1, 0}, false);
  scores.add({0.0, 0.0}, {1, 0}, true);
  EXPECT_DOUBLE_EQ(scores.averageJaccard(), 1.0 / 3.0);  // of 2 visible ones, and 1 false
  EXPECT_DOUBLE_EQ(scores.averageAccuracy(), 1.0);
  EXPECT_DOUBLE_EQ(scores.averageClaimedAccuracy(), 0.5);
}

TEST(PointScores, PointsThroughInfinityAreWrong) {
  PointScores scores;
  scores.add({kInfinity, std::nan("")}, {1, 1}, true);
  EXPECT_DOUBLE_EQ(scores.averageJaccard(), 0.0);
  EXPECT_DOUBLE_EQ(scores.averageAccuracy(), 0.0);
}

TEST(PointScores, OfNothingAreNoNumber) {
  PointScores scores;
  scores.add({1.0}, {0}, false);
  EXPECT_TRUE(std::isnan(scores.averageJaccard()));
  EXPECT_TRUE(std::isnan(scores.averageAccuracy()));
  EXPECT_TRUE(std::isnan(scores.averageClaimedAccuracy()));
}

TEST(AlignmentError, IsTheRootMeanSquareOfTheCorners) {
  const geometry::Rectangle roi = {0.0, 0.0, 101.0, 51.0};
  EXPECT_NEAR(alignmentError(shift(3.0, 4.0), shift(0.0, 0.0), roi), 5.0, 1e-12);
  Eigen::Matrix3d wider = Eigen::Matrix3d::Identity();
  wider(0, 0) = 1.04;  // two corners move by 4 px, two stay
  EXPECT_NEAR(alignmentError(wider, shift(0.0, 0.0), roi), std::sqrt(8.0), 1e-12);
  wider(2, 0) = -0.02;
  EXPECT_EQ(alignmentError(wider, shift(0.0, 0.0), roi), kInfinity);
}

TEST(Precision, IsTheShareUnderTheLimit) {
  EXPECT_DOUBLE_EQ(precision({1.0, 4.9, 5.0, 16.0, kInfinity}, 5.0), 0.4);
  EXPECT_DOUBLE_EQ(precision({1.0, 4.9, 5.0, 16.0, kInfinity}, 15.0), 0.6);
  EXPECT_TRUE(std::isnan(precision({}, 5.0)));
}
