// Splines through points: how many control points, where they lie, and what is refused.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "laparoscope_servo/features/spline.h"

namespace laparoscope_servo::features {
namespace {

using Points = std::vector<Eigen::Vector2d>;

Points circle(int count, double radius) {
  Points points;
  for (int k = 0; k < count; ++k) {
    const double angle = 2.0 * M_PI * k / count;
    points.emplace_back(200.0 + radius * std::cos(angle), 200.0 + radius * std::sin(angle));
  }
  return points;
}

Points hook() {
  return {{20, 30}, {60, 25}, {90, 60}, {95, 110}, {70, 150}, {30, 160}};
}

TEST(SplinePoints, OneControlPointEvery16PxAtLeastAsManyAsPointsAndAtMost32) {
  EXPECT_EQ(Spline::throughPoints(circle(8, 40.0), true).size(), 15) << "251 px";
  EXPECT_EQ(Spline::throughPoints(circle(8, 300.0), true).size(), 32);
  EXPECT_EQ(Spline::throughPoints(circle(40, 300.0), true).size(), 40);
  EXPECT_EQ(Spline::throughPoints(circle(100, 300.0), true).size(), Spline::kMostPoints);
  EXPECT_EQ(Spline::throughPoints({{0, 0}, {20, 5}, {41, 0}}, false).size(), Spline::kLeastPoints);
  EXPECT_EQ(Spline::throughPoints({{0, 0}, {60, 5}, {160, 0}}, false).size(), 13) << "10 pieces";
  EXPECT_EQ(Spline::throughPoints(circle(8, 40.0), true, 9).size(), 9);
}

// Knots are what the curve is bent at: they are spread over its length, wherever the points were set.
TEST(SplinePoints, KnotsLieAtEqualDistancesAlongTheCurve) {
  Points uneven;
  for (const double angle : {0.0, 0.3, 0.6, 0.9, 1.2, 2.4, 3.6, 4.8}) {
    uneven.emplace_back(200.0 + 80.0 * std::cos(angle), 200.0 + 80.0 * std::sin(angle));
  }
  for (const bool closed : {true, false}) {
    const Spline curve = Spline::throughPoints(closed ? uneven : hook(), closed, 16);
    const double expected = curve.length() / curve.pieces();
    for (int piece = 0; piece < curve.pieces(); ++piece) {
      double length = 0.0;
      for (int k = 0; k < 50; ++k) length += (curve.at(piece + 0.02 * (k + 1)) - curve.at(piece + 0.02 * k)).norm();
      EXPECT_NEAR(length, expected, 0.03 * expected) << piece;
    }
  }
}

TEST(SplinePoints, GoesAlongWithASimilarity) {
  const double c = 1.3 * std::cos(0.7), s = 1.3 * std::sin(0.7);
  const auto moved = [&](const Eigen::Vector2d& p) {
    return Eigen::Vector2d(c * p.x() - s * p.y() + 30.0, s * p.x() + c * p.y() + 9.0);
  };
  for (const bool closed : {true, false}) {
    Points points = closed ? circle(9, 60.0) : hook();
    const Spline before = Spline::throughPoints(points, closed, 14);
    for (Eigen::Vector2d& p : points) p = moved(p);
    const Spline after = Spline::throughPoints(points, closed, 14);
    for (int k = 0; k < 14; ++k) EXPECT_LT((after.controlPoint(k) - moved(before.controlPoint(k))).norm(), 1e-6) << k;
  }
}

TEST(SplinePoints, TheOrderReversedGivesTheReversedCurve) {
  Points points = hook();
  const Spline forth = Spline::throughPoints(points, false, 12);
  std::reverse(points.begin(), points.end());
  const Spline back = Spline::throughPoints(points, false, 12);
  for (int k = 0; k < 12; ++k) EXPECT_LT((forth.controlPoint(k) - back.controlPoint(11 - k)).norm(), 1e-6) << k;
}

TEST(SplinePoints, PointsOnALineGiveThatLine) {
  const Spline line = Spline::throughPoints({{10, 20}, {40, 40}, {70, 60}, {130, 100}}, false, 10);
  const Eigen::Vector2d begin(10, 20), end(130, 100);
  for (double t = 0.0; t <= line.pieces(); t += 0.25) {
    EXPECT_LT((line.at(t) - (begin + t / line.pieces() * (end - begin))).norm(), 0.6) << t;
  }
  EXPECT_NEAR(line.length(), (end - begin).norm(), 1e-6);
}

TEST(SplinePoints, ACornerMakesNoLoop) {
  const Spline curve = Spline::throughPoints({{0, 0}, {100, 0}, {103, 3}, {103, 100}}, false, 24);
  for (double t = 0.0; t <= curve.pieces(); t += 0.02) {
    EXPECT_LT(curve.at(t).x(), 106.0) << t;
    EXPECT_GT(curve.at(t).y(), -3.0) << t;
  }
}

TEST(SplinePoints, RefusalsNameTheThingItsValueAndWhatWasExpected) {
  const auto refusal = [](const Points& points, bool closed, int control_points = 0) -> std::string {
    try {
      Spline::throughPoints(points, closed, control_points);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "none";
  };
  const double inf = std::numeric_limits<double>::infinity();
  EXPECT_EQ(refusal({{0, 0}, {50, 0}}, false), "spline: number of points = 2, expected 3 to 1000");
  EXPECT_EQ(refusal({{0, 0}, {50, 0}, {50, 50}}, true), "spline: number of points = 3, expected 4 to 1000");
  EXPECT_EQ(refusal({{0, 0}, {50, 0}, {inf, 50}}, false),
            "spline: coordinate of a point = inf, expected a number below 100000 px");
  EXPECT_EQ(refusal({{0, 0}, {50, 0}, {51, 0}, {90, 0}}, false),
            "spline: distance of two neighbouring points = 1, expected at least 2 px");
  EXPECT_EQ(refusal({{0, 0}, {50, 0}, {50, 50}, {0, 1}}, true),
            "spline: distance of two neighbouring points = 1, expected at least 2 px")
      << "a closed one's last and first";
  EXPECT_EQ(refusal({{0, 0}, {10, 0}, {20, 0}}, false), "spline: length = 20, expected at least 40 px");
  EXPECT_EQ(refusal(circle(8, 40.0), true, 49), "spline: control points = 49, expected 6 to 48, or 0");
}

}  // namespace
}  // namespace laparoscope_servo::features
