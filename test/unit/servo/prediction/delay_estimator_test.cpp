#include "servo/prediction/delay_estimator.h"

#include <gtest/gtest.h>

#include <cmath>
#include <deque>
#include <functional>
#include <limits>
#include <random>

namespace laparoscope_servo::servo {
namespace {

using Eigen::Vector4d;

const Vector4d kWidth(0.004, 0.004, 0.004, 0.0004);
const Vector4d kNoise(0.002, 0.002, 0.002, 0.0002);

// A robot with delay, dead zone and lag, commanded at 25 Hz, reporting at 50 Hz.
class Robot {
 public:
  Robot(double delay, unsigned seed) : delay_(delay), random_(seed) {}

  double lag = 0.03;  // s
  double noise = 1.0;
  double report_offset = 0.0;  // s, added to the stamps of reports

  using Commands = std::function<Vector4d(double)>;

  void run(
      DelayEstimator& estimator, double from, double to, const Commands& commands,
      const std::function<void()>& after_report = [] {}) {
    for (int k = 0; from + 0.001 * k < to; ++k) {
      const double time = from + 0.001 * k;
      if (k % 40 == 0) {
        queue_.push_back({time + delay_, commands(time)});
        estimator.command(time, scope::Velocity::fromVector(queue_.back().second));
      }
      while (!queue_.empty() && queue_.front().first <= time) {
        arrived_ = queue_.front().second;
        queue_.pop_front();
      }
      for (int i = 0; i < 4; ++i) {
        const double wanted = std::abs(arrived_[i]) < kWidth[i] ? 0.0 : arrived_[i];
        executed_[i] += (wanted - executed_[i]) * 0.001 / lag;
      }
      if (k % 20 != 7) continue;
      Vector4d reported = executed_;
      for (int i = 0; i < 4; ++i) reported[i] += noise * kNoise[i] * normal_(random_);
      estimator.report(time + report_offset, scope::Velocity::fromVector(reported));
      after_report();
    }
  }

  // A servo that gets a new target every four seconds.
  Commands approaches() {
    return [this](double time) {
      const double since = std::fmod(time, 4.0);
      if (since < 0.02) {
        for (int i = 0; i < 4; ++i) goal_[i] = 0.8 * normal_(random_);
      }
      return Vector4d(Vector4d(0.1, 0.1, 0.1, 0.02).cwiseProduct(goal_) * std::exp(-2.5 * since));
    };
  }

 private:
  double delay_;
  std::mt19937 random_;
  std::normal_distribution<double> normal_;
  std::deque<std::pair<double, Vector4d>> queue_;
  Vector4d arrived_ = Vector4d::Zero();
  Vector4d executed_ = Vector4d::Zero();
  Vector4d goal_ = Vector4d::Zero();
};

Vector4d breathing(double time) {
  return {0.03 * std::sin(M_PI_2 * time), 0.0, 0.0, 0.005 * std::cos(M_PI_2 * time)};
}

DelayConfig knownLag() {
  DelayConfig config;
  config.lag = 0.03;
  return config;
}

// Measured over 30 seeds: at most 8.3 ms off.
TEST(DelayEstimator, FindsTheDelay) {
  for (const double delay : {0.08, 0.16, 0.24}) {
    for (unsigned seed = 0; seed < 3; ++seed) {
      Robot robot(delay, seed);
      DelayEstimator estimator(knownLag());
      robot.run(estimator, 0.0, 20.0, robot.approaches());
      EXPECT_TRUE(estimator.informative());
      EXPECT_GT(estimator.correlation(), 0.9);
      EXPECT_NEAR(estimator.delay(), delay, 0.012) << seed;
    }
  }
}

// Measured: 20 to 36 ms more.
TEST(DelayEstimator, AnUnknownLagIsPartOfTheDelay) {
  Robot robot(0.16, 1);
  DelayEstimator estimator{DelayConfig()};
  robot.run(estimator, 0.0, 20.0, robot.approaches());
  EXPECT_GT(estimator.delay(), 0.17);
  EXPECT_LT(estimator.delay(), 0.20);
}

TEST(DelayEstimator, SlowMotionIsEnough) {
  Robot robot(0.24, 2);
  DelayEstimator estimator(knownLag());
  robot.run(estimator, 0.0, 20.0, breathing);
  EXPECT_NEAR(estimator.delay(), 0.24, 0.015);
}

TEST(DelayEstimator, KeepsWhatItHasWithoutExcitation) {
  const std::function<Vector4d(double)> still[] = {
      [](double) { return Vector4d::Zero(); }, [](double) { return Vector4d(0.05, 0.0, 0.0, 0.01); },
      [](double time) { return Vector4d(0.005 * std::sin(3.0 * time), 0.0, 0.0, 0.0); }};
  for (const auto& commands : still) {
    Robot robot(0.24, 3);
    DelayEstimator estimator(knownLag());
    robot.run(estimator, 0.0, 15.0, commands, [&] {
      EXPECT_FALSE(estimator.informative());
      EXPECT_EQ(estimator.delay(), 0.16);
    });
  }
}

// The arm is held, or its reports are of something else.
TEST(DelayEstimator, KeepsWhatItHasWhenReportsDoNotFollow) {
  for (const double noise : {1.0, 20.0}) {
    Robot robot(0.24, 4);
    robot.lag = 1e6;
    robot.noise = noise;
    DelayEstimator estimator(knownLag());
    robot.run(estimator, 0.0, 20.0, robot.approaches(), [&] { EXPECT_EQ(estimator.delay(), 0.16); });
  }
}

TEST(DelayEstimator, ChangesSlowlyAndStaysWithinItsBounds) {
  DelayConfig config = knownLag();
  config.minimum = 0.10;
  config.maximum = 0.20;
  for (const double delay : {0.02, 0.11, 0.19, 0.35}) {
    Robot robot(delay, 5);
    DelayEstimator estimator(config);
    double last = estimator.delay();
    robot.run(estimator, 0.0, 15.0, robot.approaches(), [&] {
      EXPECT_LE(std::abs(estimator.delay() - last), config.max_rate * config.period + 1e-12);
      EXPECT_GE(estimator.delay(), config.minimum);
      EXPECT_LE(estimator.delay(), config.maximum);
      last = estimator.delay();
    });
  }
}

TEST(DelayEstimator, BearsJumpsOfTime) {
  Robot robot(0.24, 6);
  DelayEstimator estimator(knownLag());
  const Robot::Commands commands = robot.approaches();
  robot.run(estimator, 100.0, 120.0, commands);
  const double before = estimator.delay();
  for (const double start : {0.0, 1000.0}) {
    Robot again(0.24, 7);
    again.run(estimator, start, start + 2.0, again.approaches(), [&] {
      EXPECT_EQ(estimator.delay(), before);
      EXPECT_FALSE(estimator.informative());
    });
  }
  Robot last(0.24, 8);
  last.run(estimator, 0.0, 15.0, last.approaches());
  EXPECT_NEAR(estimator.delay(), 0.24, 0.012);
}

TEST(DelayEstimator, DoesNotMixTwoClocks) {
  Robot robot(0.24, 9);
  robot.report_offset = 50.0;
  DelayEstimator estimator(knownLag());
  robot.run(estimator, 0.0, 15.0, robot.approaches(), [&] { EXPECT_FALSE(estimator.informative()); });
  EXPECT_EQ(estimator.delay(), 0.16);
}

TEST(DelayEstimator, RefusesWhatIsNotFinite) {
  DelayEstimator estimator{DelayConfig()};
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(estimator.command(nan, scope::Velocity()));
  EXPECT_FALSE(estimator.command(0.0, {nan, 0, 0, 0}));
  EXPECT_FALSE(estimator.report(std::numeric_limits<double>::infinity(), scope::Velocity()));
  EXPECT_FALSE(estimator.report(0.0, {0, 0, 0, nan}));
  EXPECT_TRUE(estimator.report(0.0, scope::Velocity()));
}

TEST(DelayEstimator, ForgetsTheDelayOnlyWhenAsked) {
  Robot robot(0.24, 10);
  DelayEstimator estimator(knownLag());
  robot.run(estimator, 0.0, 15.0, robot.approaches());
  const double found = estimator.delay();
  EXPECT_NE(found, 0.16);
  estimator.reset(false);
  EXPECT_EQ(estimator.delay(), found);
  estimator.reset(true);
  EXPECT_EQ(estimator.delay(), 0.16);
}

TEST(DelayConfig, NamesWhatIsWrong) {
  EXPECT_TRUE(validate(DelayConfig()).empty());
  DelayConfig config;
  config.initial = 0.5;
  config.min_excitation.spin = 0.0;
  config.window = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(validate(config).size(), 3u);
  EXPECT_THROW(DelayEstimator{config}, std::invalid_argument);
}

}  // namespace
}  // namespace laparoscope_servo::servo
