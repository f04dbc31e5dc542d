#include "laparoscope_servo/servo/controller.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <stdexcept>

#include "laparoscope_servo/geometry/se3.h"

namespace laparoscope_servo::servo {
namespace {

const double kNan = std::numeric_limits<double>::quiet_NaN();
const double kInfinity = std::numeric_limits<double>::infinity();

// Everything that motion relies on is there, and the target is off.
ControllerInput good(double time) {
  ControllerInput input;
  input.time = time;
  input.task_error.problem.clear();
  input.task_error.valid = true;
  input.task_error.error.e_v = {0.2, -0.1, 0.1};
  input.task_error.error.e_w = {0.0, 0.0, -0.1};
  input.task_error.error.x = 0.2 / 1.1;
  input.task_error.error.y = -0.1 / 1.1;
  input.task_error.error.log_depth = std::log(1.1);
  input.task_error.error.alpha = -0.05;
  input.task_error.age = 0.02;
  input.task_error.image_age = 0.05;
  input.task_error.visible_fraction = 1.0;
  input.task_error.corner_error = 0.1;
  input.depth.problem.clear();
  input.depth.d2 = 0.1;
  input.depth.lateral_offset = 0.001;
  input.depth.age = 0.02;
  return input;
}

// The law that sees e_v and e_w alone, as they are.
ControllerConfig paper() {
  ControllerConfig config;
  config.law = LawKind::kPaper;
  config.predictor.enabled = false;
  return config;
}

bool isZero(const ControllerOutput& output) {
  return output.command.vector() == Eigen::Vector4d::Zero();
}

// A controller that has moved since time 0; the last step was at `time()`.
class Running {
 public:
  explicit Running(const ControllerConfig& config = ControllerConfig()) : controller(config) {
    EXPECT_EQ(controller.engage(good(0.0)), "");
    for (int k = 0; k <= 50; ++k) last = controller.update(good(time_ = 0.02 * k));
    EXPECT_EQ(last.state, ControllerState::kServo);
    EXPECT_FALSE(isZero(last));
  }

  double time() const { return time_; }
  // A step after the last one.
  ControllerOutput step(ControllerInput input) {
    time_ += 0.02;
    input.time = time_;
    return last = controller.update(input);
  }

  Controller controller;
  ControllerOutput last;

 private:
  double time_ = 0.0;
};

struct Failure {
  std::string name;
  std::function<void(ControllerInput&)> apply;
};

std::vector<Failure> failures() {
  std::vector<Failure> all{
      {"no task error", [](ControllerInput& i) { i.task_error = TaskErrorInput(); }},
      {"tracker lost", [](ControllerInput& i) { i.task_error.valid = false; }},
      {"task error stale", [](ControllerInput& i) { i.task_error.age = 0.26; }},
      {"image stale", [](ControllerInput& i) { i.task_error.image_age = 0.26; }},
      {"occluded", [](ControllerInput& i) { i.task_error.visible_fraction = 0.1; }},
      {"task error's age NaN", [](ControllerInput& i) { i.task_error.age = kNan; }},
      {"task error's age negative", [](ControllerInput& i) { i.task_error.age = -0.1; }},
      {"task error's problem", [](ControllerInput& i) { i.task_error.problem = "anything"; }},
      {"no depth", [](ControllerInput& i) { i.depth = DepthInput(); }},
      {"depth's problem", [](ControllerInput& i) { i.depth.problem = "tf is silent"; }},
      {"depth stale", [](ControllerInput& i) { i.depth.age = 0.26; }},
      {"depth's age NaN", [](ControllerInput& i) { i.depth.age = kNan; }},
  };
  for (const double d2 : {0.0, -0.1, 0.019, 0.251, 1e300, kNan, kInfinity, -kInfinity}) {
    all.push_back({"d2 = " + std::to_string(d2), [d2](ControllerInput& i) { i.depth.d2 = d2; }});
  }
  for (const double bad : {kNan, kInfinity, -kInfinity}) {
    for (int k = 0; k < 3; ++k) {
      const std::string suffix = "[" + std::to_string(k) + "] = " + std::to_string(bad);
      all.push_back({"e_v" + suffix, [=](ControllerInput& i) { i.task_error.error.e_v[k] = bad; }});
      all.push_back({"e_w" + suffix, [=](ControllerInput& i) { i.task_error.error.e_w[k] = bad; }});
      all.push_back({"m_star" + suffix, [=](ControllerInput& i) { i.task_error.error.m_star[k] = bad; }});
    }
    double TaskError::*const scalars[] = {
        &TaskError::x,         &TaskError::y,         &TaskError::log_depth,         &TaskError::alpha,
        &TaskError::desired_x, &TaskError::desired_y, &TaskError::desired_log_depth, &TaskError::desired_alpha};
    for (double TaskError::*const scalar : scalars) {
      all.push_back(
          {"feature = " + std::to_string(bad), [=](ControllerInput& i) { i.task_error.error.*scalar = bad; }});
    }
  }
  return all;
}

std::vector<Failure> faults() {
  return {
      {"shaft beside the insertion point", [](ControllerInput& i) { i.depth.lateral_offset = 0.02; }},
      {"lateral offset NaN", [](ControllerInput& i) { i.depth.lateral_offset = kNan; }},
      {"clock jump", [](ControllerInput& i) { i.clock_jump = "ROS time jumped back"; }},
  };
}

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
  const ScopeVelocity command = running.last.command;
  EXPECT_GT(command.pan, 0.0);
  EXPECT_LT(command.tilt * -0.1, 0.0);  // e_v.y < 0: the target is above, the scope turns up, +x
  EXPECT_LT(command.spin, 0.0);
  EXPECT_GT(command.insertion, 0.0);
  EXPECT_FALSE(running.last.reason.empty());
  EXPECT_EQ(running.last.caution, "");
  EXPECT_EQ(running.last.speed_scale, 1.0);
}

TEST(Controller, DoesNotEngageOnAnyFailure) {
  std::vector<Failure> all = failures();
  for (const Failure& fault : faults()) all.push_back(fault);
  for (const Failure& failure : all) {
    Controller controller{ControllerConfig()};
    ControllerInput input = good(0.0);
    failure.apply(input);
    EXPECT_NE(controller.engage(input), "") << failure.name;
    EXPECT_FALSE(controller.engaged()) << failure.name;
    EXPECT_TRUE(isZero(controller.update(good(0.02)))) << failure.name;
  }
}

TEST(Controller, StopsAtOnceOnAnyFailure) {
  for (const Failure& failure : failures()) {
    Running running;
    ControllerInput input = good(0.0);
    failure.apply(input);
    const ControllerOutput output = running.step(input);
    EXPECT_EQ(output.state, ControllerState::kHold) << failure.name;
    EXPECT_FALSE(output.reason.empty()) << failure.name;
    EXPECT_TRUE(isZero(output)) << failure.name;
  }
}

TEST(Controller, OnlyDisengagingClearsAFault) {
  for (const Failure& fault : faults()) {
    Running running;
    ControllerInput input = good(0.0);
    fault.apply(input);
    EXPECT_EQ(running.step(input).state, ControllerState::kFault) << fault.name;
    EXPECT_TRUE(isZero(running.last)) << fault.name;
    EXPECT_TRUE(isZero(running.step(good(0.0)))) << fault.name;
    EXPECT_NE(running.controller.engage(good(running.time())), "") << fault.name;
    running.controller.disengage("not engaged");
    EXPECT_EQ(running.step(good(0.0)).state, ControllerState::kIdle) << fault.name;
    EXPECT_EQ(running.controller.engage(good(running.time())), "") << fault.name;
    running.step(good(0.0));
    EXPECT_FALSE(isZero(running.step(good(0.0)))) << fault.name;
  }
}

// A finite error may still overflow in the law.
TEST(Controller, AVelocityThatIsNotFiniteIsAFaultAndNeverCommanded) {
  ControllerConfig config = paper();
  config.gains = {5.0, 5.0, 5.0, 0.5};
  Running running(config);
  ControllerInput input = good(0.0);
  input.task_error.error.e_v.setConstant(1e308);
  const ControllerOutput output = running.step(input);
  EXPECT_EQ(output.state, ControllerState::kFault);
  EXPECT_TRUE(isZero(output));
}

// The shafts of the poses pass beside the calibrated insertion point by more and more: that is no rigid set-up.
TEST(Controller, ShaftsThatMissEachOtherAreAFault) {
  Running running;
  ControllerInput input = good(0.0);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const auto pose = [&](double spread) {
    Eigen::Isometry3d tip = Eigen::Isometry3d::Identity();
    tip.linear() = geometry::so3Exp({M_PI + 0.2 * uniform(random), 0.2 * uniform(random), 0.0});
    tip.translation() = 0.1 * tip.linear().col(2) + spread * Eigen::Vector3d(uniform(random), uniform(random), 0.0);
    return tip;
  };
  for (int k = 0; k < 200; ++k) {
    input.depth.insertion_point_T_tip = pose(0.0005);
    ASSERT_EQ(running.step(input).state, ControllerState::kServo) << running.last.reason;
  }
  EXPECT_LT(running.controller.insertionPoint().estimate().point.norm(), 0.001);
  for (int k = 0; k < 200 && running.last.state == ControllerState::kServo; ++k) {
    input.depth.insertion_point_T_tip = pose(0.05);
    running.step(input);
  }
  EXPECT_EQ(running.last.state, ControllerState::kFault);
  EXPECT_TRUE(isZero(running.last));
}

// A calibration that is off: d2 comes from where the shafts meet.
TEST(Controller, TheEstimateTakesThePlaceOfAWrongDepth) {
  ControllerConfig config;
  config.insertion_point.prior_stddev = 0.03;
  Running running(config);
  ControllerInput input = good(0.0);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const Eigen::Vector3d real(0.0, 0.0, 0.04);  // the calibration says 0
  for (int k = 0; k < 400; ++k) {
    Eigen::Isometry3d tip = Eigen::Isometry3d::Identity();
    tip.linear() = geometry::so3Exp({M_PI + 0.2 * uniform(random), 0.2 * uniform(random), 0.0});
    tip.translation() = real + 0.14 * tip.linear().col(2);
    input.depth.insertion_point_T_tip = tip;
    running.step(input);
  }
  EXPECT_LT((running.controller.insertionPoint().estimate().point - real).norm(), 0.002);
  ControllerInput deep = input;
  deep.depth.d2 = 0.3;  // out of range by the calibration, but not by the poses
  EXPECT_EQ(running.step(deep).state, ControllerState::kServo) << running.last.reason;
  deep.depth.insertion_point_T_tip.reset();
  EXPECT_EQ(running.step(deep).state, ControllerState::kHold);
}

TEST(Controller, StandsWhileTheDeadManSwitchIsReleased) {
  ControllerConfig config;
  config.safety.dead_man_required = true;
  Controller controller(config);
  ASSERT_EQ(controller.engage(good(0.0)), "");
  EXPECT_EQ(controller.update(good(0.02)).state, ControllerState::kArmed);
  ControllerInput pressed = good(0.04);
  pressed.dead_man = {true, 0.01};
  controller.update(pressed);
  pressed.time = 0.06;
  EXPECT_FALSE(isZero(controller.update(pressed)));
  const ControllerOutput released = controller.update(good(0.08));
  EXPECT_EQ(released.state, ControllerState::kArmed);
  EXPECT_TRUE(isZero(released));
  EXPECT_TRUE(released.engaged());
}

TEST(Controller, OcclusionSlowsTheWholeVelocity) {
  ControllerConfig config = paper();
  config.dead_zone.inverse = false;  // its width would be on top
  Running running(config);
  ControllerInput half = good(0.0);
  half.task_error.error.e_v = {10.0, -10.0, -10.0};  // far beyond the limits
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

TEST(Controller, ResumesAfterAShortHoldFromRest) {
  Running running;
  ControllerInput lost = good(0.0);
  lost.task_error.valid = false;
  for (int k = 0; k < 50; ++k) EXPECT_EQ(running.step(lost).state, ControllerState::kHold);  // 1 s
  const Eigen::Vector4d limit = 0.02 * Limits().acceleration.vector() * (1.0 + 1e-9) + DeadZoneConfig().width.vector();
  const ControllerOutput output = running.step(good(0.0));
  EXPECT_EQ(output.state, ControllerState::kServo);
  EXPECT_TRUE((output.command.vector().cwiseAbs().array() <= limit.array()).all());
}

TEST(Controller, IsLostAfterALongHold) {
  Running running;
  ControllerInput lost = good(0.0);
  lost.task_error.valid = false;
  for (int k = 0; k < 110; ++k) running.step(lost);  // 2.2 s
  EXPECT_EQ(running.last.state, ControllerState::kLost);
  EXPECT_FALSE(running.controller.engaged());
  EXPECT_NE(running.last.reason.find("engage again"), std::string::npos) << running.last.reason;
  EXPECT_TRUE(isZero(running.step(good(0.0))));  // it came back, but too late
  EXPECT_EQ(running.controller.engage(good(running.time())), "");
  running.step(good(0.0));
  EXPECT_FALSE(isZero(running.step(good(0.0))));
}

TEST(Controller, HoldsThatFollowEachOtherDoNotAddUp) {
  Running running;
  ControllerInput lost = good(0.0);
  lost.task_error.valid = false;
  for (int n = 0; n < 4; ++n) {
    for (int k = 0; k < 75; ++k) running.step(lost);  // 1.5 s
    EXPECT_EQ(running.step(good(0.0)).state, ControllerState::kServo);
  }
}

TEST(Controller, WithoutResumeTimeNoHoldResumes) {
  ControllerConfig config;
  config.safety.resume_time = 0.0;
  Running running(config);
  ControllerInput lost = good(0.0);
  lost.task_error.valid = false;
  EXPECT_EQ(running.step(lost).state, ControllerState::kHold);
  EXPECT_EQ(running.step(good(0.0)).state, ControllerState::kLost);
}

TEST(Controller, TimeThatJumpsOrIsNotFiniteIsAFault) {
  for (const double time : {0.5, -1e9, 1e9, 2.1, kNan, kInfinity, -kInfinity}) {
    Running running;
    ControllerOutput output = running.controller.update(good(time));
    EXPECT_EQ(output.state, ControllerState::kFault) << time;
    EXPECT_TRUE(isZero(output)) << time;
    output = running.controller.update(good(running.time() + 0.02));
    EXPECT_TRUE(isZero(output)) << time;
  }
}

TEST(Controller, DisengagesAtOnce) {
  Running running;
  running.controller.disengage("asked to");
  const ControllerOutput output = running.step(good(0.0));
  EXPECT_EQ(output.state, ControllerState::kIdle);
  EXPECT_EQ(output.reason, "asked to");
  EXPECT_TRUE(isZero(output));
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
  input.task_error.error.e_v = {-100.0, 100.0, 100.0};
  input.task_error.error.x = -100.0;
  input.task_error.error.y = 100.0;
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
    const double size = std::pow(10.0, 3.0 * uniform(random));
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
      const Eigen::Vector4d limit = step * config.limits.acceleration.vector() * (1.0 + 1e-9) + 2.0 * config.dead_zone.width.vector();
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

}  // namespace
}  // namespace laparoscope_servo::servo
