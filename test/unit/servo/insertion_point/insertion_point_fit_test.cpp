#include "laparoscope_servo/servo/insertion_point_fit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace laparoscope_servo::servo {
namespace {

using Eigen::Vector3d;

constexpr double kScope = 0.3;  // m
const Vector3d kPoint{0.574, -0.079, -0.05};

std::mt19937 engine(unsigned seed) {
  return std::mt19937(seed);
}

Vector3d noise(std::mt19937& random, double sigma) {
  std::normal_distribution<double> n(0.0, 1.0);
  const double x = n(random);
  const double y = n(random);
  return sigma * Vector3d(x, y, n(random));
}

struct Swing {
  double cone = 0.12;  // rad, half angle
  double position_noise = 0.0;
  double direction_noise = 0.0;
  bool plane = false;  // to and fro instead of round
  double depth = 0.1;  // m
  Vector3d point = kPoint;

  Shaft at(double phase, std::mt19937& random) const {
    const double u = cone * std::sin(phase);
    const double v = plane ? 0.0 : cone * std::cos(phase);
    const Vector3d a = Vector3d(u, v, -1.0).normalized();
    return {point - (kScope - depth) * a + noise(random, position_noise),
            (a + noise(random, direction_noise)).normalized()};
  }
};

InsertionPointFitter swung(const Swing& swing, unsigned seed = 1, int count = 400,
                           const InsertionPointFitConfig& config = InsertionPointFitConfig()) {
  InsertionPointFitter fitter(config);
  std::mt19937 random = engine(seed);
  for (int k = 0; k < count; ++k) fitter.add(swing.at(2.0 * M_PI * k / count, random));
  return fitter;
}

bool mentions(const std::vector<std::string>& problems, const std::string& text) {
  for (const std::string& problem : problems) {
    if (problem.find(text) != std::string::npos) return true;
  }
  return false;
}

TEST(InsertionPointFit, FindsThePointOfExactShafts) {
  for (const bool plane : {false, true}) {
    Swing swing;
    swing.plane = plane;
    swing.cone = plane ? 0.16 : 0.12;
    const InsertionPointFitter fitter = swung(swing);
    EXPECT_TRUE(fitter.problems(kScope).empty()) << fitter.problems(kScope).front();
    // The noise of directions that is taken off without being there.
    EXPECT_LT((fitter.fit().point - kPoint).norm(), plane ? 1e-3 : 5e-4);
    EXPECT_LT(fitter.fit().residual, 1e-4);
    EXPECT_NEAR(fitter.fit().cone, plane ? 0.16 / std::sqrt(3.0) : 0.12, 0.003);
    EXPECT_NEAR(fitter.fit().nearest, 0.2, 1e-3);
    EXPECT_NEAR(fitter.fit().farthest, 0.2, 1e-3);
  }
}

// The stated uncertainty is neither too small nor just large: errors over it are as of a normal distribution.
TEST(InsertionPointFit, StatedUncertaintyIsThatOfTheErrors) {
  InsertionPointFitConfig config;
  config.wobble = 0.0;
  Swing swing;
  swing.position_noise = config.position_noise;
  swing.direction_noise = config.direction_noise;
  double sum = 0.0;
  int beyond = 0;
  int worse_than_a_millimetre = 0;
  const int runs = 300;
  for (int run = 0; run < runs; ++run) {
    const InsertionPointFitter fitter = swung(swing, static_cast<unsigned>(run), 400, config);
    EXPECT_TRUE(fitter.problems(kScope).empty()) << fitter.problems(kScope).front();
    const Vector3d error = fitter.fit().point - kPoint;
    const double squared = error.dot(fitter.fit().covariance.inverse() * error);
    sum += squared;
    beyond += squared > 16.27 ? 1 : 0;  // 0.1 % of chi² with three degrees of freedom
    worse_than_a_millimetre += error.norm() > 1e-3 ? 1 : 0;
  }
  EXPECT_GT(sum / runs, 1.2) << "expected 3";
  EXPECT_LT(sum / runs, 4.5) << "expected 3";
  EXPECT_LE(beyond, 4);
  EXPECT_LE(worse_than_a_millimetre, runs / 10);
}

TEST(InsertionPointFit, AWiderConeIsSurer) {
  Swing narrow;
  narrow.cone = 0.08;
  Swing wide;
  wide.cone = 0.2;
  EXPECT_LT(swung(wide).fit().stddev, 0.6 * swung(narrow).fit().stddev);
}

TEST(InsertionPointFit, RefusesTooFewPoses) {
  const InsertionPointFitter fitter = swung(Swing(), 1, 12);
  EXPECT_TRUE(mentions(fitter.problems(kScope), "poses of different directions: 12, expected at least 30"));
  EXPECT_TRUE(mentions(InsertionPointFitter(InsertionPointFitConfig()).problems(kScope), "0, expected at least 30"));
}

TEST(InsertionPointFit, RefusesASmallCone) {
  InsertionPointFitConfig config;
  config.spacing = 0.001;
  Swing swing;
  swing.cone = 0.05;
  const InsertionPointFitter fitter = swung(swing, 1, 400, config);
  EXPECT_GT(fitter.fit().poses, 100);
  EXPECT_TRUE(mentions(fitter.problems(kScope), "the shaft has turned by 0.05 rad, expected at least 0.07 rad"));
}

TEST(InsertionPointFit, RefusesShaftsThatDoNotMeet) {
  InsertionPointFitter fitter{InsertionPointFitConfig()};
  std::mt19937 random = engine(1);
  Swing swing;
  for (int k = 0; k < 200; ++k) {
    swing.point = kPoint + Vector3d(k < 100 ? 0.0 : 0.015, 0.0, 0.0);  // the trocar is pushed aside on the way
    fitter.add(swing.at(0.1 * k, random));
    swing.cone = 0.08 + 0.0005 * k;
  }
  EXPECT_TRUE(mentions(fitter.problems(kScope), "the shafts pass the point at 0.0")) << fitter.fit().residual;
  EXPECT_TRUE(mentions(fitter.problems(kScope), "expected at most 0.003 m"));
}

TEST(InsertionPointFit, RefusesAPointThatIsTooUncertain) {
  InsertionPointFitConfig config;
  config.max_stddev = 0.0005;
  EXPECT_TRUE(mentions(swung(Swing(), 1, 400, config).problems(kScope), "standard deviation is"));
}

TEST(InsertionPointFit, RefusesAPointBeyondTheShaft) {
  const InsertionPointFitter fitter = swung(Swing());
  EXPECT_TRUE(mentions(fitter.problems(0.15), "along the shaft, expected above 0 and below its length of 0.15 m"));
  Swing behind;
  behind.depth = 0.35;
  EXPECT_TRUE(mentions(swung(behind).problems(kScope), "along the shaft"));
}

TEST(InsertionPointFit, StandingStillAddsNothing) {
  InsertionPointFitter fitter{InsertionPointFitConfig()};
  std::mt19937 random = engine(1);
  EXPECT_TRUE(fitter.add(Swing().at(0.0, random)));
  for (int k = 0; k < 1000; ++k) EXPECT_FALSE(fitter.add(Swing().at(0.0, random)));
  EXPECT_EQ(fitter.fit().poses, 1);
  EXPECT_FALSE(fitter.fit().known);
}

TEST(InsertionPointFit, LongMotionNearOneDirectionLeavesRoomForOthers) {
  InsertionPointFitConfig config;
  config.max_poses = 100;
  InsertionPointFitter fitter(config);
  std::mt19937 random = engine(1);
  Swing swing;
  std::size_t taken = 0;
  for (int k = 0; k < 3000; ++k) {
    swing.cone = k < 2000 ? 0.03 * k / 2000.0 : 0.2;
    taken += fitter.add(swing.at(0.37 * k, random)) ? 1 : 0;
    ASSERT_LT(fitter.fit().poses, 100);
    ASSERT_EQ(fitter.kept().size(), static_cast<std::size_t>(fitter.fit().poses));
    ASSERT_LT(fitter.kept().back(), taken);
    ASSERT_TRUE(std::is_sorted(fitter.kept().begin(), fitter.kept().end()));
  }
  EXPECT_TRUE(fitter.problems(kScope).empty()) << fitter.problems(kScope).front();
  EXPECT_GT(fitter.fit().cone, 0.12);
}

TEST(InsertionPointFit, WhatIsNotFiniteIsNotKept) {
  InsertionPointFitter fitter{InsertionPointFitConfig()};
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(fitter.add({{nan, 0, 0}, Vector3d::UnitZ()}));
  EXPECT_FALSE(fitter.add({{0, 0, 0}, {0, nan, 1}}));
  EXPECT_FALSE(fitter.add({{0, 0, 0}, {0, 0, 2}}));
  EXPECT_EQ(fitter.fit().poses, 0);
}

TEST(InsertionPointFit, ConfigurationNamesEveryError) {
  EXPECT_TRUE(validate(InsertionPointFitConfig()).empty());
  InsertionPointFitConfig config;
  config.spacing = config.min_cone = config.max_residual = config.max_stddev = config.position_noise =
      config.direction_noise = config.wobble = std::numeric_limits<double>::quiet_NaN();
  config.min_poses = 4;
  config.max_poses = 1;
  EXPECT_EQ(validate(config).size(), 9u);
  EXPECT_THROW(InsertionPointFitter{config}, std::invalid_argument);
}

}  // namespace
}  // namespace laparoscope_servo::servo
