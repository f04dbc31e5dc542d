#include "servo/prediction/target_motion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

namespace laparoscope_servo::servo {
namespace {

const double kPeriod = 0.04;

// Noisy measurements of x = place(t) for `duration` [s].
TargetMotion observed(double duration, const std::function<double(double)>& place, double moved = 0.0,
                      unsigned seed = 1) {
  const TargetMotionConfig config;
  TargetMotion motion(config);
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  for (double t = 0.0; t < duration; t += kPeriod) {
    const Features noise(config.centre_noise * normal(random), config.centre_noise * normal(random),
                         config.depth_noise * normal(random), config.orientation_noise * normal(random));
    motion.observe(t, Features(place(t), 0.0, 0.0, 0.0) + noise, Features::Constant(moved));
  }
  return motion;
}

TEST(TargetMotion, AveragesWhatStandsStillAndTakesNoNoiseForMotion) {
  int believed = 0;
  double squares = 0.0;
  for (unsigned seed = 1; seed <= 200; ++seed) {
    const TargetPrediction prediction = observed(
                                            4.0, [](double) { return 0.2; }, 0.0, seed)
                                            .predict(4.1);
    believed += prediction.velocity != Features::Zero();
    squares += (prediction.place[0] - 0.2) * (prediction.place[0] - 0.2);
  }
  EXPECT_LE(believed, 10);
  EXPECT_LT(std::sqrt(squares / 200.0), 0.9 * TargetMotionConfig().centre_noise);
}

TEST(TargetMotion, FollowsASteadyMotionAheadOfTime) {
  for (const double speed : {0.04, -0.06}) {
    const TargetPrediction prediction = observed(4.0, [&](double t) { return speed * t; }).predict(4.2);
    EXPECT_NEAR(prediction.velocity[0], speed, 0.2 * std::abs(speed));
    EXPECT_NEAR(prediction.place[0], 4.2 * speed, 0.0025);
    EXPECT_EQ(prediction.velocity[1], 0.0);
  }
}

// While the scope moves, what the target seems to do may be what is not known of the scope: its velocity is believed
// later.
TEST(TargetMotion, IsCarefulWhileTheScopeMoves) {
  const auto drift = [](double t) { return 0.06 * t; };
  EXPECT_NE(observed(1.0, drift).predict(1.1).velocity[0], 0.0);
  EXPECT_EQ(observed(1.0, drift, 0.01).predict(1.1).velocity[0], 0.0);
}

// Another region is selected, or the tissue is pulled: no velocity comes of it, which would take the scope past it.
TEST(TargetMotion, AJumpIsAnotherTargetAndNoMotion) {
  const auto jump = [](double t) { return t < 3.0 ? 0.0 : 0.1; };
  for (double t = 3.02; t < 4.0; t += kPeriod) {
    const TargetPrediction prediction = observed(t, jump).predict(t + 0.2);
    EXPECT_NEAR(prediction.place[0], 0.1, 0.002) << t;
    EXPECT_EQ(prediction.velocity[0], 0.0) << t;
  }
}

TEST(TargetMotion, AJumpIsReachedWithinASecond) {
  const TargetPrediction prediction = observed(4.0, [](double t) { return t < 3.0 ? 0.0 : 0.1; }).predict(4.0);
  EXPECT_NEAR(prediction.place[0], 0.1, 0.01);
}

TEST(TargetMotion, StartsAnewWhenTimeDoesNotIncrease) {
  TargetMotion motion = observed(2.0, [](double t) { return t; });
  motion.observe(0.5, Features::Constant(7.0), Features::Zero());
  EXPECT_EQ(motion.predict(0.5).place, Features::Constant(7.0));
  EXPECT_EQ(motion.predict(5.0).velocity, Features::Zero());
  motion.reset();
  EXPECT_TRUE(motion.empty());
  EXPECT_EQ(motion.predict(1.0).place, Features::Zero());
}

}  // namespace
}  // namespace laparoscope_servo::servo
