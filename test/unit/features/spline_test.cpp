#include "laparoscope_servo/features/spline.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "unit/features/curve_check.h"

namespace laparoscope_servo::features {
namespace {

using Points = std::vector<Eigen::Vector2d>;

Points bean() {
  Points result;
  for (int k = 0; k < 10; ++k) {
    const double angle = 2.0 * M_PI * k / 10, radius = 60.0 + 15.0 * std::cos(2.0 * angle);
    result.emplace_back(150.0 + radius * std::cos(angle), 120.0 + radius * std::sin(angle));
  }
  return result;
}

Points wave() {
  Points result;
  for (int k = 0; k < 8; ++k) result.emplace_back(40.0 + 30.0 * k, 100.0 + 15.0 * std::sin(0.9 * k));
  return result;
}

Spline splineOf(bool closed) {
  return Spline::throughPoints(closed ? bean() : wave(), closed);
}

// How far the curve is from the point along the normal: where it crosses the normal next to it.
double distance(const Spline& curve, const Eigen::Vector2d& point, const Eigen::Vector2d& normal) {
  const Eigen::Vector2d tangent(-normal.y(), normal.x());
  constexpr int kSteps = 400;
  double best = 1e9;
  for (int k = 0; k < kSteps; ++k) {
    double from = curve.pieces() * static_cast<double>(k) / kSteps;
    double to = curve.pieces() * static_cast<double>(k + 1) / kSteps;
    const auto along = [&](double t) { return tangent.dot(curve.at(t) - point); };
    const bool rises = along(from) < along(to);
    if ((along(from) > 0.0) == (along(to) > 0.0)) continue;
    for (int i = 0; i < 50; ++i) ((along(0.5 * (from + to)) < 0.0) == rises ? from : to) = 0.5 * (from + to);
    const double here = normal.dot(curve.at(from) - point);
    if (std::abs(here) < std::abs(best)) best = here;
  }
  return best;
}

TEST(Spline, goesThroughThePoints) {
  for (const bool closed : {true, false}) {
    const Points points = closed ? bean() : wave();
    const Spline curve = Spline::throughPoints(points, closed, 24);
    for (const Eigen::Vector2d& point : points) {
      double nearest = 1e9;
      for (double t = 0.0; t <= curve.pieces(); t += 0.01) nearest = std::min(nearest, (curve.at(t) - point).norm());
      EXPECT_LT(nearest, 0.5);
    }
    EXPECT_EQ(curve.size(), 24);
    EXPECT_EQ(curve.isClosed(), closed);
    if (!closed) {
      EXPECT_LT((curve.at(0.0) - points.front()).norm(), 1e-6);
      EXPECT_LT((curve.at(curve.pieces()) - points.back()).norm(), 1e-6);
    }
  }
}

TEST(Spline, jacobiansAreThoseOfItsDisplacement) {
  for (const bool closed : {true, false}) {
    SCOPED_TRACE(closed);
    expectJacobiansHold(splineOf(closed), distance);
    expectSitesAreInOrder(splineOf(closed), 4.0);
  }
}

TEST(Spline, sitesAreEvenlySpacedAlongAllOfIt) {
  for (const bool closed : {true, false}) {
    const Spline curve = splineOf(closed);
    std::vector<Site> sites;
    curve.sites(4.0, 200, sites);
    const double step = curve.length() / static_cast<double>(sites.size());
    EXPECT_GT(step, 2.8);
    EXPECT_LT(step, 5.7);
    for (std::size_t i = 1; i < sites.size(); ++i) {
      EXPECT_NEAR((sites[i].point - sites[i - 1].point).norm(), step, 0.05 * step);
      EXPECT_NEAR(distance(curve, sites[i].point, sites[i].normal), 0.0, 1e-6);
    }
  }
}

TEST(Spline, curvatureOfACircle) {
  // Along growing angles, from x to y, the normal points outwards.
  for (const double direction : {1.0, -1.0}) {
    Points points;
    for (int k = 0; k < 16; ++k) {
      points.emplace_back(100.0 + 50.0 * std::cos(direction * k * M_PI / 8),
                          90.0 + 50.0 * std::sin(direction * k * M_PI / 8));
    }
    std::vector<Site> sites;
    Spline::throughPoints(points, true).sites(4.0, 200, sites);
    for (const Site& site : sites) {
      EXPECT_NEAR(site.curvature, direction * 0.02, 1e-3);
      EXPECT_NEAR(site.normal.dot(site.point - Eigen::Vector2d(100.0, 90.0)), direction * 50.0, 0.1);
    }
  }
}

TEST(Spline, isCarriedByAnAffineMotionPointByPoint) {
  Eigen::Matrix3d motion;
  motion << 1.1, -0.2, 7.0, 0.15, 0.9, -12.0, 0.0, 0.0, 1.0;
  for (const bool closed : {true, false}) {
    const Spline before = splineOf(closed);
    Spline after = before;
    after.transform(motion);
    for (double t = 0.0; t < before.pieces(); t += 0.3) {
      EXPECT_LT((after.at(t) - (motion * before.at(t).homogeneous()).head<2>()).norm(), 1e-9);
    }
  }
}

TEST(Spline, changeIsSizeOrTheLargestDeformation) {
  const Spline before = splineOf(true);
  Eigen::Matrix3d motion = Eigen::Matrix3d::Identity();
  motion.topLeftCorner<2, 2>() << 0.8, -0.6, 0.6, 0.8;
  motion.topRightCorner<2, 1>() << 50.0, -20.0;
  Spline after = before;
  after.transform(motion);
  EXPECT_NEAR(after.change(before), 1.0, 1e-9);
  motion.topLeftCorner<2, 2>() *= 0.8;
  after = before;
  after.transform(motion);
  EXPECT_NEAR(after.change(before), 1.25, 1e-9);
  after = before;
  Eigen::VectorXd step = Eigen::VectorXd::Zero(after.parameters());
  step[3] = 20.0;
  after.move(step);
  EXPECT_GT(after.change(before), 1.15);
  EXPECT_LT(after.change(before), 1.4);
}

// The prior expects a motion of the whole, and carries what is not seen along.
TEST(Spline, whatIsNotSeenFollowsTheRest) {
  for (const bool closed : {true, false}) {
    const Spline before = splineOf(closed);
    Spline curve = before;
    curve.settle({}, Eigen::MatrixXd(), 0.04);
    Eigen::MatrixXd information;
    Eigen::VectorXd mean;
    curve.known(before, 6.0, information, mean);
    ASSERT_EQ(mean.size(), curve.parameters());
    EXPECT_LT(mean.norm(), 1e-9);
    // Seen on one half only: it has moved by (2, -1).
    const Eigen::Vector2d shift(2.0, -1.0);
    std::vector<Site> sites;
    curve.sites(4.0, 200, sites);
    Eigen::MatrixXd normal = information;
    Eigen::VectorXd right = Eigen::VectorXd::Zero(curve.parameters());
    for (std::size_t i = 0; i < sites.size() / 2; ++i) {
      Eigen::VectorXd row = Eigen::VectorXd::Zero(curve.parameters());
      for (int k = 0; k < sites[i].count; ++k) {
        row[(sites[i].first + k) % curve.parameters()] = sites[i].jacobian[static_cast<std::size_t>(k)];
      }
      normal += 25.0 * row * row.transpose();
      right += 25.0 * row * sites[i].normal.dot(shift);
    }
    Spline moved = curve;
    moved.move(normal.ldlt().solve(right));
    for (const Site& site : sites) {
      EXPECT_NEAR(distance(moved, site.point, site.normal), site.normal.dot(shift), 0.5) << site.slot;
    }
    // And it is expected where a deformation of the past has brought it: back again.
    Eigen::VectorXd step = Eigen::VectorXd::Zero(curve.parameters());
    step[4] = 5.0;
    moved = curve;
    moved.move(step);
    moved.known(before, 6.0, information, mean);
    EXPECT_NEAR(mean[4], -5.0, 1.5);
  }
}

TEST(Spline, controlPointsAreLaidAnewWhenTheyGather) {
  Spline curve = splineOf(true);
  Eigen::VectorXd step = Eigen::VectorXd::Zero(curve.parameters());
  for (int k = 0; k < 4; ++k) step[k] = 35.0;
  curve.move(step);
  ASSERT_TRUE(curve.isSound());
  const Spline before = curve;
  curve.settle({}, Eigen::MatrixXd(), 0.04);
  double shortest = 1e9, longest = 0.0;
  for (int k = 0; k < curve.size(); ++k) {
    const double piece = (curve.at((k + 1) % curve.size()) - curve.at(k)).norm();
    shortest = std::min(shortest, piece);
    longest = std::max(longest, piece);
  }
  EXPECT_LT(longest, 1.3 * shortest);
  std::vector<Site> sites;
  before.sites(4.0, 200, sites);
  for (const Site& site : sites) EXPECT_NEAR(distance(curve, site.point, site.normal), 0.0, 2.0);
}

TEST(Spline, isNotSoundWhenItTurnsBackOrIsNotFinite) {
  Spline curve = splineOf(true);
  EXPECT_TRUE(curve.isSound());
  Eigen::VectorXd step = Eigen::VectorXd::Zero(curve.parameters());
  step[2] = 90.0;
  curve.move(step);
  EXPECT_FALSE(curve.isSound());
  curve = splineOf(false);
  step = Eigen::VectorXd::Constant(curve.parameters(), std::numeric_limits<double>::quiet_NaN());
  curve.move(step);
  EXPECT_FALSE(curve.isSound());
  EXPECT_FALSE(Spline().isSound());
}

TEST(Spline, refusesWhatIsNoCurve) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(Spline::throughPoints({{0, 0}, {50, 0}, {50, 50}}, true), std::invalid_argument);
  EXPECT_THROW(Spline::throughPoints({{0, 0}, {50, 0}}, false), std::invalid_argument);
  EXPECT_THROW(Spline::throughPoints({{0, 0}, {50, 0}, {nan, 50}}, false), std::invalid_argument);
  EXPECT_THROW(Spline::throughPoints({{0, 0}, {50, 0}, {50, 0}, {90, 0}}, false), std::invalid_argument);
  EXPECT_THROW(Spline::throughPoints({{0, 0}, {10, 0}, {20, 0}}, false), std::invalid_argument);
  EXPECT_THROW(Spline::throughPoints(bean(), true, 5), std::invalid_argument);
  EXPECT_THROW(Spline::throughPoints(bean(), true, 49), std::invalid_argument);
  EXPECT_THROW(Spline({{0, 0}, {50, 0}, {50, 50}}, true), std::invalid_argument);
  EXPECT_THROW(Spline({{0, 0}, {50, 0}, {0, 1}, {50, 1}, {0, 2}, {50, 2}}, false), std::invalid_argument);
}

TEST(Spline, aChangeThatIsNotFiniteIsNotTakenForASmallOne) {
  const Spline before = splineOf(true);
  for (int k = 0; k < before.parameters(); ++k) {
    Spline curve = before;
    Eigen::VectorXd step = Eigen::VectorXd::Zero(curve.parameters());
    step[k] = std::numeric_limits<double>::quiet_NaN();
    curve.move(step);
    EXPECT_FALSE(curve.change(before) < 1e300) << k;
  }
}

}  // namespace
}  // namespace laparoscope_servo::features
