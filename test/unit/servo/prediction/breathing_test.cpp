#include "servo/prediction/breathing.h"

#include <gtest/gtest.h>

#include <cmath>

namespace laparoscope_servo::servo {
namespace {

const double kPeriod = 0.04;
const double kRate = 0.25;

Features place(double t) {
  const double breath = std::sin(2.0 * M_PI * kRate * t) + 0.3 * std::sin(4.0 * M_PI * kRate * t);
  return {0.2 + 0.01 * breath, -0.1 + 0.09 * breath, 0.02 * breath, 0.3};
}

Breathing breathingWith(double rate) {
  BreathingConfig config;
  config.rate = rate;
  return Breathing(config, TargetMotionConfig());
}

// Each feature's own part, ahead of time; alpha is nobody's.
TEST(Breathing, FollowsTheBreathInEachFeature) {
  for (const double rate : {0.0, kRate}) {
    Breathing breathing = breathingWith(rate);
    int changes = 0;
    double t = 0.0;
    for (; t < 40.0; t += kPeriod) changes += breathing.observe(t, place(t));
    EXPECT_EQ(changes, 1);
    EXPECT_NEAR(breathing.rate(), kRate, 0.002);
    const Features ahead = place(t + 0.2) - Features(0.2, -0.1, 0.0, 0.3);
    const Features speed = (place(t + 0.201) - place(t + 0.199)) / 0.002;
    const TargetPrediction prediction = breathing.predict(t + 0.2);
    for (int k = 0; k < 3; ++k) {
      EXPECT_NEAR(prediction.place[k], ahead[k], 0.02 * (k == 1 ? 0.09 : 0.02)) << k;
      EXPECT_NEAR(prediction.velocity[k], speed[k], 0.05 * (k == 1 ? 0.14 : 0.03)) << k;
    }
    EXPECT_EQ(prediction.place[3], 0.0);
    EXPECT_EQ(prediction.velocity[3], 0.0);
  }
}

TEST(Breathing, SaysWhenItsWordEnds) {
  Breathing breathing = breathingWith(0.0);
  double t = 0.0;
  for (; t < 40.0; t += kPeriod) breathing.observe(t, place(t));
  ASSERT_GT(breathing.rate(), 0.0);
  const double held = t;
  bool ended = false;
  for (; t < held + 10.0; t += kPeriod) ended |= breathing.observe(t, place(held));
  EXPECT_TRUE(ended);
  EXPECT_EQ(breathing.rate(), 0.0);
  EXPECT_EQ(breathing.predict(t).velocity, Features::Zero());
}

TEST(Breathing, IsNothingBeforeItIsFoundAndWhenSwitchedOff) {
  Breathing fresh = breathingWith(kRate);
  EXPECT_EQ(fresh.predict(1.0).place, Features::Zero());
  BreathingConfig config;
  config.enabled = false;
  Breathing off(config, TargetMotionConfig());
  for (double t = 0.0; t < 40.0; t += kPeriod) EXPECT_FALSE(off.observe(t, place(t)));
  EXPECT_EQ(off.predict(40.0).velocity, Features::Zero());
}

}  // namespace
}  // namespace laparoscope_servo::servo
