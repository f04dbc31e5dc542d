#include "laparoscope_servo/servo/scope_servo.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "plane_loop.h"

namespace laparoscope_servo::servo {
namespace {

using test::kZ;
using test::PlaneLoop;
using test::straight;

const double kPeriod = 0.02;

// The loop with an ideal robot that executes after a delay, images every other step.
class Loop {
 public:
  Loop(const ControllerConfig& config, double delay) : servo(config), robot_(10.0, 0.2), delay_(delay) { robot_.add(-1.0, ScopeVelocity()); }

  ScopeVelocity step(bool report = false) {
    if (count_ % 2 == 0) {
      image_ = loop.error();
      image_time_ = time_;
    }
    if (report) servo.report(time_, ScopeVelocity::fromVector(robot_.velocity(time_, delay_)));
    const ScopeVelocity command = servo.command(input(), limits);
    execute(command);
    return command;
  }

  void drive(const ScopeVelocity& wanted) { execute(servo.drive(input(), wanted)); }
  void restart() { servo.restart(time_); }

  ScopeServo servo;
  PlaneLoop loop{Eigen::Vector3d::UnitZ(), kZ, straight()};
  ServoLimits limits;

 private:
  ServoInput input() const {
    ServoInput input;
    input.time = time_;
    input.image_time = image_time_;
    input.error = image_;
    input.scope = loop.scope();
    input.period = count_ == 0 ? 0.0 : kPeriod;
    return input;
  }

  void execute(const ScopeVelocity& command) {
    robot_.add(time_, command);
    for (int k = 0; k < 20; ++k) {
      const double t = time_ + (k + 0.5) * kPeriod / 20.0;
      loop.move(ScopeVelocity::fromVector(robot_.velocity(t, delay_)), kPeriod / 20.0);
    }
    time_ += kPeriod;
    ++count_;
  }

  CommandHistory robot_;
  double delay_;
  TaskError image_;
  double time_ = 0.0, image_time_ = 0.0;
  int count_ = 0;
};

ControllerConfig withoutDeadZone() {
  ControllerConfig config;
  config.dead_zone.inverse = false;
  config.dead_zone.width = ScopeVelocity();
  return config;
}

double centre(const PlaneLoop& loop) {
  const TaskError error = loop.error();
  return std::hypot(error.x - error.desired_x, error.y - error.desired_y);
}

// What the predictor is for: this gain without it swings, with it settles in a second, and without overshooting by more than noise would.
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
    const ScopeVelocity command = loop.step();
    EXPECT_LE(command.insertion, 0.0);  // it would have to go deeper
    EXPECT_TRUE((command.vector().cwiseAbs().array() <= limit.array()).all());
    turned |= command.pan != 0.0;
  }
  EXPECT_TRUE(turned);
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
  const ScopeVelocity wanted = ScopeVelocity::fromVector(2.0 * (limits.velocity.vector() - width));
  Eigen::Vector4d last = Eigen::Vector4d::Zero();
  for (int k = 0; k < 50; ++k) {
    const Eigen::Vector4d command = servo.drive(driven(k), wanted).vector();
    EXPECT_TRUE(((command - last).array() <= step.array() * (1.0 + 1e-9)).all());
    last = command;
  }
  EXPECT_TRUE(last.isApprox(limits.velocity.vector(), 1e-9));
  const ScopeVelocity slow{0.01, -0.02, 0.0, 0.001};
  for (int k = 50; k < 100; ++k) last = servo.drive(driven(k), slow).vector();
  EXPECT_TRUE(last.isApprox(Eigen::Vector4d(0.014, -0.024, 0.0, 0.0014), 1e-9)) << last.transpose();
  for (int k = 100; k < 120; ++k) last = servo.drive(driven(k), ScopeVelocity()).vector();
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

// The image turns, the tissue goes along: a released scope does not spin, with any optics.
TEST(ScopeServo, ReleasedItNeverSpins) {
  ControllerConfig config;
  config.spin = SpinMode::kReleased;
  ScopeServo servo(config);
  bool moved_at_all = false;
  for (int k = 0; k < 300; ++k) {
    ServoInput input;
    input.time = input.image_time = 0.04 * k;
    input.period = 0.04;
    input.scope = {obliqueOptics(0.5236), 0.1};
    input.error.x = 0.002 * k;
    input.error.alpha = 0.004 * k;
    const ScopeVelocity command = servo.command(input, ServoLimits());
    ASSERT_EQ(command.spin, 0.0) << k;
    moved_at_all |= command.pan != 0.0;
  }
  EXPECT_TRUE(moved_at_all);
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
    servo.report(input.time, ScopeVelocity());
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

// The picture hangs upside down: noise does not decide in each image which way round it is turned.
TEST(ScopeServo, HalfATurnIsGoneInOneDirection) {
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0.0, 0.05);
  for (int start = 0; start < 10; ++start) {
    ScopeServo servo{ControllerConfig()};
    double alpha = M_PI, last = 0.0;
    int reversals = 0;
    for (int k = 0; k < 800; ++k) {
      ServoInput input;
      input.time = input.image_time = 0.04 * k;
      input.period = 0.04;
      input.scope = straight();
      input.error.alpha = std::remainder(alpha + noise(random), 2.0 * M_PI);
      const double spin = servo.command(input, ServoLimits()).spin;
      const bool far = std::abs(std::remainder(alpha, 2.0 * M_PI)) > 0.3;
      if (far && spin * last < 0.0) ++reversals;
      if (spin != 0.0) last = spin;
      alpha -= 0.04 * spin;
    }
    EXPECT_EQ(reversals, 0) << start;
    EXPECT_LT(std::abs(std::remainder(alpha, 2.0 * M_PI)), 0.1);
  }
}

// The angle of a scope that is kept upright, in each step; its images are `lag` [s] older than its poses.
std::vector<double> keptUpright(double lag) {
  ControllerConfig config = withoutDeadZone();
  config.spin = SpinMode::kUpright;
  config.predictor.delay = 0.0;
  config.predictor.measure_delay = false;
  config.rest.enabled = false;
  config.horizon.up = {0.0, -1.0, 0.0};
  ScopeServo servo(config);
  std::vector<double> angles{0.5};
  for (int k = 0; k < 400; ++k) {
    ServoInput input;
    input.time = input.pose_time = kPeriod * k;
    input.image_time = std::max(0.0, input.time - lag);
    input.period = kPeriod;
    input.scope = straight();
    Eigen::Isometry3d tip = Eigen::Isometry3d::Identity();
    tip.linear() = geometry::so3Exp({0.0, 0.0, angles.back()});
    input.insertion_point_T_tip = tip;
    angles.push_back(angles.back() + kPeriod * servo.command(input, ServoLimits()).spin);
  }
  return angles;
}

// What the scope has turned since the image was taken is not counted twice, by its pose and by what it was told.
TEST(ScopeServo, TheHorizonIsThatOfTheImage) {
  const std::vector<double> at_once = keptUpright(0.0), late = keptUpright(0.2);
  EXPECT_LT(std::abs(at_once.back()), 1e-3);
  for (std::size_t k = 0; k < late.size(); ++k) EXPECT_NEAR(late[k], at_once[k], 2e-3) << k;
}

TEST(ScopeServo, WhatIsNotFiniteComesOutSo) {
  ScopeServo servo{ControllerConfig()};
  ServoInput input;
  input.error.x = std::nan("");
  EXPECT_FALSE(servo.command(input, ServoLimits()).vector().allFinite());
}

}  // namespace
}  // namespace laparoscope_servo::servo
