#include "servo/shaping/oscillation_guard.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

namespace laparoscope_servo::servo {
namespace {

// The factor after `duration` [s] at 25 Hz of this error of x.
double after(double duration, const std::function<double(double)>& x,
             const OscillationConfig& config = OscillationConfig()) {
  OscillationGuard guard(config);
  double factor = 1.0;
  for (double t = 0.0; t < duration; t += 0.04) {
    TaskError error;
    error.x = x(t);
    factor = guard.update(t, error);
    EXPECT_EQ(factor, guard.factor());
  }
  return factor;
}

TEST(OscillationGuard, LowersTheGainOfALoopThatSwings) {
  for (const double period : {0.5, 0.7, 0.9}) {
    const double factor = after(3.0, [&](double t) { return 0.02 * std::sin(2.0 * M_PI * t / period); });
    EXPECT_LT(factor, 1.0) << period;
    EXPECT_GE(factor, OscillationConfig().least);
  }
}

TEST(OscillationGuard, StopsAtItsLeastFactor) {
  EXPECT_EQ(after(60.0, [](double t) { return 0.02 * std::sin(2.0 * M_PI * t / 0.6); }), OscillationConfig().least);
}

// A breath, also a fast one with strong harmonics, a decay, noise, a square step: no swinging.
TEST(OscillationGuard, LeavesWhatTissueDoes) {
  for (const double frequency : {0.1, 0.25, 0.5}) {
    EXPECT_EQ(after(60.0,
                    [&](double t) {
                      const double phase = 2.0 * M_PI * frequency * t;
                      return 0.09 * (std::sin(phase) + 0.3 * std::sin(2.0 * phase));
                    }),
              1.0)
        << frequency;
  }
  EXPECT_EQ(after(20.0, [](double t) { return 0.3 * std::exp(-3.0 * t); }), 1.0);
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0.0, 0.0006);  // 0.25 px at 400 px
  EXPECT_EQ(after(600.0, [&](double) { return noise(random); }), 1.0);
  EXPECT_EQ(after(20.0, [](double t) { return t > 5.0 ? 0.1 : -0.1; }), 1.0);
}

TEST(OscillationGuard, SeesEachFeature) {
  for (int feature = 0; feature < 4; ++feature) {
    OscillationGuard guard{OscillationConfig()};
    for (double t = 0.0; t < 3.0; t += 0.04) {
      TaskError error;
      double* const values[] = {&error.x, &error.y, &error.log_depth, &error.alpha};
      *values[feature] = 0.05 * std::sin(2.0 * M_PI * t / 0.6);
      guard.update(t, error);
    }
    EXPECT_LT(guard.factor(), 1.0) << feature;
    guard.reset();
    EXPECT_EQ(guard.factor(), 1.0);
  }
}

TEST(OscillationGuard, CanBeSwitchedOffAndBearsNotANumber) {
  OscillationConfig config;
  config.enabled = false;
  EXPECT_EQ(after(
                5.0, [](double t) { return 0.02 * std::sin(2.0 * M_PI * t / 0.6); }, config),
            1.0);
  EXPECT_EQ(after(5.0, [](double) { return std::nan(""); }), 1.0);
}

}  // namespace
}  // namespace laparoscope_servo::servo
