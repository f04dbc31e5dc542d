#include "servo/scope_servo.h"

#include <gtest/gtest.h>

#include <cmath>

#include "scope_loop.h"
#include "servo/law/paper_law.h"
#include "servo/task/scope_displacement.h"

namespace laparoscope_servo::servo {
namespace {

using test::centre;
using test::kPeriod;
using test::kZ;
using test::Loop;
using test::straight;
using test::withoutDeadZone;

// What the predictor is for: this gain without it swings, with it settles in a second, and without overshooting by more
// than noise would.
TEST(ScopeServo, BearsTheDelayByPrediction) {
  for (const bool predicts : {true, false}) {
    ControllerConfig config = withoutDeadZone();
    config.predictor.enabled = predicts;
    config.features.centre = 10.0;
    config.oscillation.enabled = false;
    Loop loop(config, 0.16);
    loop.loop.offset({0.02, 0.0, 0.0, 0.0});
    const double side = loop.loop.error().x;
    double overshoot = 0.0;
    for (int k = 0; k < 300; ++k) {
      loop.step();
      overshoot = std::max(overshoot, -loop.loop.error().x * (side > 0.0 ? 1.0 : -1.0));
    }
    if (predicts) {
      EXPECT_LT(centre(loop.loop), 0.001);
      EXPECT_LT(overshoot, 0.002);
    } else {
      EXPECT_GT(overshoot, 0.01);
    }
  }
}

TEST(ScopeServo, MeasuresTheDelayFromReports) {
  for (const double delay : {0.1, 0.2}) {
    Loop loop(withoutDeadZone(), delay);
    for (int n = 0; n < 8; ++n) {
      loop.loop.offset({n % 2 == 0 ? 0.05 : -0.05, 0.0, 0.0, 0.0});
      for (int k = 0; k < 75; ++k) loop.step(true);
    }
    EXPECT_NEAR(loop.servo.delay(), delay, 0.02);
  }
  ControllerConfig config = withoutDeadZone();
  config.predictor.measure_delay = false;
  Loop fixed(config, 0.2);
  fixed.loop.offset({0.05, 0.0, 0.0, 0.0});
  for (int k = 0; k < 200; ++k) fixed.step(true);
  EXPECT_EQ(fixed.servo.delay(), config.predictor.delay);
}

TEST(ScopeServo, TakesGainBackWhenWhatItBelievesIsWrong) {
  ControllerConfig config = withoutDeadZone();
  config.features.desired_depth = 2.0 * kZ;  // the loop is faster than believed
  config.features.centre = 16.0;
  config.predictor.delay = 0.05;
  config.predictor.measure_delay = false;
  Loop loop(config, 0.2);
  loop.loop.offset({0.05, 0.03, 0.0, 0.0});
  for (int k = 0; k < 1000; ++k) loop.step();
  EXPECT_LT(loop.servo.gainFactor(), 1.0);
  EXPECT_LT(centre(loop.loop), 0.004);
  loop.restart();
  EXPECT_EQ(loop.servo.gainFactor(), 1.0);
}

TEST(ScopeServo, KeepsToItsLimits) {
  Loop loop(ControllerConfig(), 0.16);
  loop.loop.offset({0.1, 0.05, 0.3, -0.01});
  loop.limits.insertion_allowed = false;
  const Eigen::Vector4d limit = Limits().velocity.vector() * (1.0 + 1e-12);
  bool turned = false;
  for (int k = 0; k < 100; ++k) {
    const scope::Velocity command = loop.step();
    EXPECT_LE(command.insertion, 0.0);  // it would have to go deeper
    EXPECT_TRUE((command.vector().cwiseAbs().array() <= limit.array()).all());
    turned |= command.pan != 0.0;
  }
  EXPECT_TRUE(turned);
}

// Each goes as fast as it may, however far the other has to go.
TEST(ScopeServo, SpinAndInsertionDoNotWaitForEachOther) {
  Loop both(withoutDeadZone(), 0.16), insertion(withoutDeadZone(), 0.16);
  both.loop.offset({0.0, 0.0, 0.6, -0.005});
  insertion.loop.offset({0.0, 0.0, 0.0, -0.005});
  for (int k = 0; k < 100; ++k) {
    both.step();
    insertion.step();
  }
  EXPECT_GT(std::abs(both.loop.error().alpha), 0.3) << "still far to spin";
  EXPECT_NEAR(both.loop.error().log_depth, insertion.loop.error().log_depth, 0.002);
  EXPECT_LT(std::abs(both.loop.error().log_depth), 0.005);
}

TEST(ScopeServo, IsSlowerWhenItHasTo) {
  Loop full(ControllerConfig(), 0.16), slow(ControllerConfig(), 0.16);
  full.loop.offset({0.02, 0.0, 0.0, 0.0});
  slow.loop.offset({0.02, 0.0, 0.0, 0.0});
  slow.limits.scale = 0.25;
  for (int k = 0; k < 20; ++k) {
    full.step();
    slow.step();
  }
  EXPECT_LT(centre(full.loop), 0.9 * centre(slow.loop));
}

TEST(ScopeServo, AStopIsAtOnceAndStartsFromRest) {
  Loop loop(ControllerConfig(), 0.16);
  loop.loop.offset({0.1, 0.0, 0.0, 0.0});
  for (int k = 0; k < 30; ++k) loop.step();
  loop.servo.stop(30 * kPeriod);
  const Eigen::Vector4d first = loop.step().vector();
  const Eigen::Vector4d limit = kPeriod * Limits().acceleration.vector() + DeadZoneConfig().width.vector();
  EXPECT_TRUE((first.cwiseAbs().array() <= limit.array() * (1.0 + 1e-9)).all());
}

ServoInput driven(int step, double d2 = 0.1) {
  ServoInput input;
  input.time = step * kPeriod;
  input.scope.d2 = d2;
  input.period = kPeriod;
  return input;
}

TEST(ScopeServo, IsNotDrivenBeyondItsRange) {
  const double deepest = ControllerConfig().range.max_depth;
  for (const double d2 : {deepest, deepest + 0.01}) {
    ScopeServo servo{ControllerConfig()};
    for (int k = 0; k < 50; ++k) EXPECT_EQ(servo.drive(driven(k, d2), {0.05, 0.0, 0.0, 0.01}).insertion, 0.0);
    EXPECT_TRUE(servo.atBound());
    EXPECT_LT(servo.drive(driven(50, d2), {0.05, 0.0, 0.0, -0.01}).insertion, 0.0);
    EXPECT_FALSE(servo.atBound());
  }
}

TEST(ScopeServo, DrivesWithinItsLimitsThroughTheDeadZone) {
  ScopeServo servo{ControllerConfig()};
  const Limits limits;
  const Eigen::Vector4d width = DeadZoneConfig().width.vector();
  const Eigen::Vector4d step = kPeriod * limits.acceleration.vector() + width;
  // In proportion to the limits that the dead zone leaves: the direction is kept.
  const scope::Velocity wanted = scope::Velocity::fromVector(2.0 * (limits.velocity.vector() - width));
  Eigen::Vector4d last = Eigen::Vector4d::Zero();
  for (int k = 0; k < 50; ++k) {
    const Eigen::Vector4d command = servo.drive(driven(k), wanted).vector();
    EXPECT_TRUE(((command - last).array() <= step.array() * (1.0 + 1e-9)).all());
    last = command;
  }
  EXPECT_TRUE(last.isApprox(limits.velocity.vector(), 1e-9));
  const scope::Velocity slow{0.01, -0.02, 0.0, 0.001};
  for (int k = 50; k < 100; ++k) last = servo.drive(driven(k), slow).vector();
  EXPECT_TRUE(last.isApprox(Eigen::Vector4d(0.014, -0.024, 0.0, 0.0014), 1e-9)) << last.transpose();
  for (int k = 100; k < 120; ++k) last = servo.drive(driven(k), scope::Velocity()).vector();
  EXPECT_EQ(last, Eigen::Vector4d::Zero());
}

// What was driven by hand and is still under way when the law takes over is known to the predictor.
TEST(ScopeServo, FollowsFromWhereItWasDriven) {
  Loop loop(withoutDeadZone(), 0.16);
  for (int k = 0; k < 100; ++k) loop.step();
  for (int k = 0; k < 25; ++k) loop.drive({0.08, 0.0, 0.0, 0.0});
  loop.restart();
  const double side = loop.loop.error().x;
  EXPECT_LT(side, -0.05);
  double overshoot = 0.0;
  for (int k = 0; k < 200; ++k) {
    loop.step();
    overshoot = std::max(overshoot, loop.loop.error().x);
  }
  EXPECT_LT(centre(loop.loop), 0.002);
  EXPECT_LT(overshoot, 0.002);  // 0.02 when it is not
}

// An arm that is held: what it was told is not taken for the target's motion when it goes on.
TEST(ScopeServo, KnowsARobotThatDoesNotMove) {
  ScopeServo servo{ControllerConfig()};
  ServoInput input;
  input.scope = straight();
  input.error.x = 0.05;
  for (int k = 0; k < 100; ++k) {
    input.time = input.image_time = 0.02 * k;
    input.period = 0.02;
    servo.report(input.time, scope::Velocity());
    servo.command(input, ServoLimits());
  }
  EXPECT_TRUE(servo.blocked());
  Loop loop(ControllerConfig(), 0.16);
  loop.loop.offset({0.1, 0.0, 0.0, 0.0});
  for (int k = 0; k < 100; ++k) {
    loop.step(true);
    ASSERT_FALSE(loop.servo.blocked()) << k;
  }
}

// Another region is selected while the scope moves: it starts from rest.
TEST(ScopeServo, AnotherRegionStartsFromRest) {
  ScopeServo servo{ControllerConfig()};
  ServoInput input;
  input.scope = straight();
  input.error.x = 0.3;
  double fast = 0.0;
  for (int k = 0; k < 50; ++k) {
    input.time = input.image_time = 0.02 * k;
    input.period = 0.02;
    fast = servo.command(input, ServoLimits()).pan;
  }
  EXPECT_GT(std::abs(fast), 0.05);
  input.time = input.image_time = 1.0;
  input.error.desired_x = 0.25;
  input.error.m_star.x() = 0.25;
  const double limit = 0.02 * Limits().acceleration.pan + DeadZoneConfig().width.pan;
  EXPECT_LE(std::abs(servo.command(input, ServoLimits()).pan), limit * (1.0 + 1e-9));
}

// Near the edge of the view the way to the target is not found, but the scope's own motion counts as it does elsewhere:
// to the middle of the period in which the command is executed.
TEST(ScopeServo, KnowsWhatIsUnderWayWhereTheTargetIsNotPredicted) {
  ControllerConfig config = withoutDeadZone();
  config.law = LawKind::kPaper;
  config.predictor.measure_delay = false;
  config.limits.velocity = config.limits.acceleration = {1e4, 1e4, 1e4, 1e4};
  const double period = 0.1;
  ScopeServo servo{config};
  const scope::Velocity driven{0.2, 0.1, 0.3, 0.0};
  ServoInput input;
  input.period = period;
  input.scope = straight();
  for (int k = 0; k < 10; ++k) {
    input.time = period * k;
    ASSERT_EQ(servo.drive(input, driven).vector(), driven.vector());
  }
  input.time = input.image_time = period * 10;
  input.error.x = 20.0;
  input.error.e_v = {20.0, 0.0, 0.0};
  ASSERT_FALSE(displacementToTarget(input.error, input.scope, config.features.desired_depth).allFinite());
  const Eigen::Vector4d under_way = (config.predictor.delay + 0.5 * period) * driven.vector();
  const Eigen::Vector4d expected =
      PaperLaw(config.gains)
          .velocity(moved(input.error, under_way, input.scope, config.features.desired_depth), input.scope)
          .sum()
          .vector();
  const Eigen::Vector4d command = servo.command(input, ServoLimits()).vector();
  EXPECT_TRUE(command.head<3>().isApprox(expected.head<3>(), 1e-9))
      << command.transpose() << ", not " << expected.transpose();
}

TEST(ScopeServo, WhatIsNotFiniteComesOutSo) {
  ScopeServo servo{ControllerConfig()};
  ServoInput input;
  input.error.x = std::nan("");
  EXPECT_FALSE(servo.command(input, ServoLimits()).vector().allFinite());
}

}  // namespace
}  // namespace laparoscope_servo::servo
