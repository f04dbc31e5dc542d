#include "laparoscope_servo/servo/controller.h"

#include <gtest/gtest.h>

#include <random>
#include <stdexcept>

#include "controller_input.h"
#include "laparoscope_servo/geometry/se3.h"

namespace laparoscope_servo::servo {
namespace {

using namespace test;

TEST(Controller, RefusesABadConfiguration) {
  ControllerConfig config;
  config.gains.pan = -1.0;
  EXPECT_THROW(Controller{config}, std::invalid_argument);
}

TEST(Controller, StandsStillUntilEngaged) {
  Controller controller{ControllerConfig()};
  for (int k = 0; k < 10; ++k) {
    const ControllerOutput output = controller.update(good(0.02 * k));
    EXPECT_EQ(output.state, ControllerState::kIdle);
    EXPECT_FALSE(output.engaged());
    EXPECT_FALSE(output.reason.empty());
    EXPECT_TRUE(isZero(output));
  }
}

TEST(Controller, FollowsTheLawOnceEngaged) {
  const Running running;
  const scope::Velocity command = running.last.command;
  EXPECT_GT(command.pan, 0.0);
  EXPECT_LT(command.tilt * -0.1, 0.0);  // e_v.y < 0: the target is above, the scope turns up, +x
  EXPECT_LT(command.spin, 0.0);
  EXPECT_GT(command.insertion, 0.0);
  EXPECT_FALSE(running.last.reason.empty());
  EXPECT_EQ(running.last.caution, "");
  EXPECT_EQ(running.last.speed_scale, 1.0);
}

// A calibration that is off: d2 comes from where the shafts meet.
TEST(Controller, TheEstimateTakesThePlaceOfAWrongDepth) {
  ControllerConfig config;
  config.insertion_point.prior_stddev = 0.03;
  Running running(config);
  ControllerInput input = good(0.0);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const Eigen::Vector3d real(0.0, 0.0, 0.04);  // the calibration says 0, and 40 mm more of d2
  input.depth.d2 = 0.18;
  for (int k = 0; k < 400; ++k) {
    Eigen::Isometry3d tip = Eigen::Isometry3d::Identity();
    tip.linear() = geometry::so3Exp({M_PI + 0.2 * uniform(random), 0.2 * uniform(random), 0.0});
    tip.translation() = real + 0.14 * tip.linear().col(2);
    input.depth.insertion_point_T_tip = tip;
    running.step(input);
  }
  EXPECT_LT((running.controller.figures().insertion_point.point - real).norm(), 0.002);
  // As if the calibration were right.
  ControllerConfig trusting = config;
  trusting.insertion_point.use = false;
  Running right(trusting);
  ControllerInput calibrated = good(0.0);
  calibrated.depth.d2 = 0.14;
  for (int k = 0; k < 400; ++k) right.step(calibrated);
  EXPECT_NEAR(running.step(input).command.insertion, right.step(calibrated).command.insertion, 2e-4);
  EXPECT_EQ(running.last.state, ControllerState::kServo);
  // One of the two says that it is out of range.
  input.depth.d2 = 0.26;
  EXPECT_EQ(running.step(input).state, ControllerState::kHold);
}

// The estimate jumps with the first poses; what the law is told does not.
TEST(Controller, TheDepthIsCorrectedSlowly) {
  Running running;
  ControllerInput input = good(0.0);
  Eigen::Isometry3d tip = Eigen::Isometry3d::Identity();
  tip.linear() = geometry::so3Exp({M_PI, 0.0, 0.0});
  tip.translation() = 0.14 * tip.linear().col(2);
  input.depth.d2 = 0.1;  // 40 mm less than the pose says
  input.depth.insertion_point_T_tip = tip;
  Eigen::Vector4d last = running.step(input).command.vector();
  for (int k = 0; k < 500; ++k) {
    const Eigen::Vector4d now = running.step(input).command.vector();
    ASSERT_LT((now - last).norm(), 0.002) << k;
    last = now;
  }
}

TEST(Controller, OcclusionSlowsTheWholeVelocity) {
  ControllerConfig config = paper();
  config.dead_zone.inverse = false;  // its width would be on top
  Running running(config);
  ControllerInput half = good(0.0);
  half.task_error.error.e_v = {5.0, -5.0, -0.9};  // far beyond the limits
  for (int k = 0; k < 100; ++k) running.step(half);
  const Eigen::Vector4d fast = running.last.command.vector();
  half.task_error.visible_fraction = 0.35;
  for (int k = 0; k < 100; ++k) running.step(half);
  EXPECT_NEAR(running.last.speed_scale, 0.5, 1e-12);
  EXPECT_NE(running.last.caution, "");
  const Eigen::Vector4d slow = running.last.command.vector();
  EXPECT_GT(fast.cwiseAbs().maxCoeff(), 0.0);
  EXPECT_TRUE(slow.isApprox(0.5 * fast, 1e-9));
}

TEST(Controller, GoesNoDeeperOnPoorConfidenceButOutwards) {
  Running running;
  ControllerInput unsure = good(0.0);
  unsure.task_error.corner_error = 1.2;
  running.step(unsure);
  EXPECT_EQ(running.last.state, ControllerState::kServo);
  for (int k = 0; k < 50; ++k) EXPECT_EQ(running.step(unsure).command.insertion, 0.0);
  EXPECT_GT(running.last.command.pan, 0.0);
  unsure.task_error.error.log_depth = -0.3;
  for (int k = 0; k < 10; ++k) running.step(unsure);
  EXPECT_LT(running.last.command.insertion, 0.0);
}

TEST(Controller, EngagingAgainChangesNothing) {
  Running running;
  Running twin;
  EXPECT_EQ(running.controller.engage(good(running.time())), "");
  EXPECT_EQ(running.step(good(0.0)).command.vector(), twin.step(good(0.0)).command.vector());
}

TEST(Controller, APauseIsNoLicenceForAJump) {
  Running running;
  ControllerInput input = good(running.time() + SafetyConfig().max_clock_step - 1e-9);
  input.task_error.error.e_v = {-20.0, 20.0, 15.0};
  input.task_error.error.x = -5.0;
  input.task_error.error.y = 5.0;
  const Eigen::Vector4d change = running.controller.update(input).command.vector() - running.last.command.vector();
  const Eigen::Vector4d limit =
      SafetyConfig().max_period * Limits().acceleration.vector() * (1.0 + 1e-9) + 2.0 * DeadZoneConfig().width.vector();
  EXPECT_TRUE((change.cwiseAbs().array() <= limit.array()).all());
}

// Whatever comes, valid or not: the command is finite and within its limits, a change is a permitted one or a stop.
TEST(Controller, LimitsHoldForAnyInput) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const ControllerConfig config;
  const Eigen::Vector4d velocity = config.limits.velocity.vector() * (1.0 + 1e-9);
  std::vector<Failure> all = failures();
  for (const Failure& fault : faults()) all.push_back(fault);
  Controller controller(config);
  double time = 0.0;
  Eigen::Vector4d last = Eigen::Vector4d::Zero();
  int moved = 0;
  for (int k = 0; k < 20000; ++k) {
    const double dt = 0.05 * (uniform(random) + 1.0);
    time += dt;
    ControllerInput input = good(time);
    const double size = std::pow(10.0, 2.0 * uniform(random) - 1.0);  // up to 10: what cannot be is among it
    for (int i = 0; i < 3; ++i) {
      input.task_error.error.e_v[i] = size * uniform(random);
      input.task_error.error.e_w[i] = size * uniform(random);
    }
    input.task_error.error.x = size * uniform(random);
    input.task_error.error.y = size * uniform(random);
    input.task_error.error.log_depth = size * uniform(random);
    input.task_error.error.alpha = size * uniform(random);
    input.task_error.age = 0.1 * (uniform(random) + 1.0);
    if (k % 17 == 0) all[static_cast<std::size_t>(k / 17) % all.size()].apply(input);
    input.task_error.visible_fraction = 1.0 - 0.75 * std::abs(uniform(random));
    input.task_error.corner_error = 1.0 + uniform(random);
    if (!controller.engaged()) controller.disengage("not engaged");
    if (!controller.engaged()) controller.engage(input);
    const ControllerOutput output = controller.update(input);
    const Eigen::Vector4d command = output.command.vector();
    ASSERT_TRUE(command.allFinite());
    ASSERT_TRUE((command.cwiseAbs().array() <= velocity.array()).all());
    if (output.state != ControllerState::kServo) {
      ASSERT_TRUE(isZero(output));
    } else {
      const double step = std::min(dt, config.safety.max_period);
      // The dead zone's inverse may go from one side of it to the other, which the arm does not execute.
      const Eigen::Vector4d limit =
          step * config.limits.acceleration.vector() * (1.0 + 1e-9) + 2.0 * config.dead_zone.width.vector();
      Eigen::Vector4d change = (command - last).cwiseAbs();
      if (command[3] == 0.0) change[3] = 0.0;  // not deeper: that is at once
      ASSERT_TRUE((change.array() <= limit.array() + 1e-12).all());
      ++moved;
    }
    last = command;
  }
  EXPECT_GT(moved, 10000);
}

TEST(Controller, RestsAtTheTarget) {
  Controller controller{ControllerConfig()};
  ControllerInput arrived = good(0.0);
  TaskError& error = arrived.task_error.error;
  error.e_v = {2e-4, 2e-4, 8e-4};  // 0.1 px at 400 px, 0.1 % of scale
  error.e_w = {0.0, 0.0, 2e-3};
  error.x = error.y = 2e-4;
  error.log_depth = 8e-4;
  error.alpha = 1e-3;
  ASSERT_EQ(controller.engage(arrived), "");
  for (int k = 0; k < 100; ++k) {
    arrived.time = 0.02 * k;
    const ControllerOutput output = controller.update(arrived);
    EXPECT_TRUE(isZero(output));
    EXPECT_EQ(output.state, ControllerState::kServo);
  }
}

// The budget of the guard goes on counting after a clock that said no time.
TEST(Controller, ATimeThatIsNoNumberStopsItAndBlindsNothing) {
  for (const double time : {kNan, kInfinity}) {
    Controller controller{ControllerConfig()};
    EXPECT_EQ(controller.engage(good(0.0)), "");
    EXPECT_EQ(controller.update(good(0.0)).state, ControllerState::kServo);
    const ControllerOutput stopped = controller.update(good(time));
    EXPECT_EQ(stopped.state, ControllerState::kFault) << time;
    EXPECT_TRUE(isZero(stopped)) << time;
    controller.disengage("test");
    EXPECT_EQ(controller.engage(good(0.04)), "");
    for (int k = 3; k < 20; ++k) controller.update(good(0.02 * k));
    EXPECT_GT(controller.figures().unconfirmed, 0.0) << time;
  }
}

}  // namespace
}  // namespace laparoscope_servo::servo
