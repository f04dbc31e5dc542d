#include "servo/prediction/command_history.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

namespace laparoscope_servo::servo {
namespace {

TEST(CommandHistory, ExecutesNothingBeforeTheFirstCommand) {
  CommandHistory history(3.0, 2.0);
  EXPECT_EQ(history.displacement(0.0, 10.0, 0.2), Eigen::Vector4d::Zero());
  history.add(1.0, {0.1, 0.0, 0.0, 0.0});
  EXPECT_EQ(history.displacement(0.0, 1.2, 0.2), Eigen::Vector4d::Zero());
  EXPECT_EQ(history.velocity(1.19, 0.2), Eigen::Vector4d::Zero());
  EXPECT_NEAR(history.displacement(0.0, 2.2, 0.2)[0], 0.1, 1e-15);
  EXPECT_EQ(history.velocity(1.2, 0.2)[0], 0.1);
}

// The integral of a random staircase, shifted by the delay.
TEST(CommandHistory, IntegratesWhatIsExecuted) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  CommandHistory history(100.0, 10.0);
  std::vector<std::pair<double, double>> steps;
  for (int k = 0; k < 100; ++k) {
    steps.emplace_back(0.05 * k, u(random));
    history.add(steps.back().first, {0.0, steps.back().second, 0.0, 0.0});
  }
  const double delay = 0.16;
  for (int k = 0; k < 50; ++k) {
    const double begin = 2.5 + 2.5 * u(random), end = begin + 1.0 + u(random);
    double sum = 0.0;
    const double dt = 1e-4;
    for (double t = begin; t < end; t += dt) {
      double v = 0.0;
      for (const auto& step : steps) {
        if (step.first + delay <= t) v = step.second;
      }
      sum += dt * v;
    }
    EXPECT_NEAR(history.displacement(begin, end, delay)[1], sum, 1e-3);
  }
  EXPECT_NEAR((history.displacement(1.0, 2.0, delay) + history.displacement(2.0, 3.0, delay) -
               history.displacement(1.0, 3.0, delay))
                  .norm(),
              0.0, 1e-12);
  EXPECT_EQ(history.displacement(2.0, 2.0, delay), Eigen::Vector4d::Zero());
}

TEST(CommandHistory, KeepsWhatIsStillInForce) {
  CommandHistory history(0.5, 20.0);
  history.add(0.0, {0.1, 0.0, 0.0, 0.0});
  history.add(10.0, {0.2, 0.0, 0.0, 0.0});
  EXPECT_NEAR(history.displacement(9.0, 10.0, 0.0)[0], 0.1, 1e-15);
  history.add(10.6, {0.3, 0.0, 0.0, 0.0});
  EXPECT_NEAR(history.displacement(10.2, 10.6, 0.0)[0], 0.08, 1e-12);
}

TEST(CommandHistory, StartsAnewWhenTimeGoesBack) {
  CommandHistory history(3.0, 2.0);
  history.add(5.0, {0.1, 0.0, 0.0, 0.0});
  history.add(4.0, {0.2, 0.0, 0.0, 0.0});
  EXPECT_NEAR(history.displacement(4.0, 5.0, 0.0)[0], 0.2, 1e-15);
  history.clear();
  EXPECT_EQ(history.displacement(4.0, 5.0, 0.0), Eigen::Vector4d::Zero());
}

// A robot that hears nothing more stops by itself.
TEST(CommandHistory, ACommandEndsWithItsLifetime) {
  CommandHistory history(3.0, 0.2);
  history.add(1.0, {0.1, 0.0, 0.0, 0.0});
  EXPECT_NEAR(history.displacement(1.0, 9.0, 0.16)[0], 0.02, 1e-15);
  EXPECT_EQ(history.velocity(1.35, 0.16)[0], 0.1);
  EXPECT_EQ(history.velocity(1.37, 0.16)[0], 0.0);
  history.add(1.5, {0.3, 0.0, 0.0, 0.0});  // after a pause
  EXPECT_NEAR(history.displacement(1.0, 9.0, 0.16)[0], 0.02 + 0.06, 1e-15);
  EXPECT_NEAR(history.displacement(1.3, 1.7, 0.16)[0], 0.1 * 0.06 + 0.3 * 0.04, 1e-15);
  EXPECT_EQ(history.velocity(1.6, 0.16)[0], 0.0);
}

TEST(CommandHistory, KeepsNoNumberThatIsNone) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CommandHistory history(3.0, 2.0);
  history.add(1.0, {0.1, 0.0, 0.0, 0.0});
  history.add(1.5, {nan, 0.1, 0.0, 0.0});
  EXPECT_TRUE(history.displacement(1.0, 3.0, 0.0).isApprox(Eigen::Vector4d(0.05, 0.0, 0.0, 0.0)));
  history.add(nan, {0.3, 0.0, 0.0, 0.0});
  EXPECT_EQ(history.displacement(0.0, 9.0, 0.0), Eigen::Vector4d::Zero());
  history.add(1.7, {0.2, 0.0, 0.0, 0.0});
  EXPECT_NEAR(history.displacement(1.0, 1.8, 0.0)[0], 0.02, 1e-15);
}

}  // namespace
}  // namespace laparoscope_servo::servo
