// What stops the scope, and what lets it go on.
#include <gtest/gtest.h>

#include <random>

#include "controller_input.h"
#include "laparoscope_servo/geometry/se3.h"
#include "laparoscope_servo/servo/controller.h"

namespace laparoscope_servo::servo {
namespace {

using namespace test;

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

TEST(Controller, AVelocityThatIsNotFiniteIsAFaultAndNeverCommanded) {
  Running running;
  ControllerInput input = good(0.0);
  input.depth.camera_R_shaft.setConstant(kNan);
  const ControllerOutput output = running.step(input);
  EXPECT_EQ(output.state, ControllerState::kFault);
  EXPECT_NE(output.reason.find("velocity is not finite"), std::string::npos) << output.reason;
  EXPECT_TRUE(isZero(output));
}

// Finite, and yet nothing that a tracker can have seen.
TEST(Controller, ATaskErrorThatCannotBeIsNotFollowed) {
  Running running(paper());
  ControllerInput input = good(0.0);
  input.task_error.error.e_v.setConstant(1e308);
  EXPECT_EQ(running.step(input).state, ControllerState::kHold);
  EXPECT_NE(running.last.reason.find("task error: "), std::string::npos) << running.last.reason;
  EXPECT_TRUE(isZero(running.last));
  EXPECT_EQ(running.step(good(0.0)).state, ControllerState::kServo);
}

// The grabber shows its last picture, with new stamps, while the scope moves.
TEST(Controller, APictureThatRepeatsIsAHoldUntilAnotherIsSeen) {
  Running running;
  ControllerInput input = good(0.0);
  int k = 0;
  const auto step = [&] {  // an image every other step
    input.task_error.image_time = 1.0 + 0.04 * (k++ / 2);
    return running.step(input).state;
  };
  while (k < 100) {
    input.task_error.error.x = 0.2 + 1e-9 * (k / 2);
    ASSERT_EQ(step(), ControllerState::kServo) << k << running.last.reason;
  }
  const int last_picture = k;
  while (k < last_picture + 20 && step() == ControllerState::kServo) {
  }
  EXPECT_EQ(running.last.state, ControllerState::kHold);
  EXPECT_NE(running.last.reason.find("picture repeats"), std::string::npos) << running.last.reason;
  EXPECT_LE(k - last_picture, 2 * 3);
  for (int more = 0; more < 50; ++more) EXPECT_EQ(step(), ControllerState::kHold) << "standing still is no excuse";
  EXPECT_NE(running.controller.problem(input), "");
  input.task_error.error.x = 0.21;
  k += 2;
  EXPECT_EQ(step(), ControllerState::kServo);
}

TEST(Controller, ARestingScopeMaySeeTheSamePicture) {
  Controller controller{ControllerConfig()};
  ControllerInput input = good(0.0);
  input.task_error.error = TaskError();
  ASSERT_EQ(controller.engage(input), "");
  for (int k = 0; k < 500; ++k) {
    input.time = 0.02 * k;
    input.task_error.image_time = 0.04 * (k / 2);
    ASSERT_EQ(controller.update(input).state, ControllerState::kServo) << k;
  }
  // A target that starts to move shows nothing of the scope's own motion before its delay.
  for (int k = 500; k < 508; ++k) {
    input.time = 0.02 * k;
    input.task_error.image_time = 0.04 * (k / 2);
    input.task_error.error.x = 0.1;
    ASSERT_EQ(controller.update(input).state, ControllerState::kServo) << k;
  }
}

TEST(Controller, WhatEndsTheEngagementIsLost) {
  Running running;
  ControllerInput input = good(0.0);
  input.ended = "/aesop has connected anew";
  EXPECT_EQ(running.step(input).state, ControllerState::kLost);
  EXPECT_TRUE(isZero(running.last));
  EXPECT_NE(running.last.reason.find("connected anew"), std::string::npos) << running.last.reason;
  EXPECT_EQ(running.step(good(0.0)).state, ControllerState::kLost);
}

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
  EXPECT_LT(running.controller.figures().insertion_point.point.norm(), 0.001);
  for (int k = 0; k < 200 && running.last.state == ControllerState::kServo; ++k) {
    input.depth.insertion_point_T_tip = pose(0.05);
    running.step(input);
  }
  EXPECT_EQ(running.last.state, ControllerState::kFault);
  EXPECT_TRUE(isZero(running.last));
}

TEST(Controller, StandsWhileTheDeadManSwitchIsReleased) {
  ControllerConfig config;
  config.safety.dead_man_required = true;
  Controller controller(config);
  ASSERT_EQ(controller.engage(good(0.0)), "");
  EXPECT_EQ(controller.update(good(0.02)).state, ControllerState::kArmed);
  ControllerInput pressed = good(0.04);
  pressed.dead_man = {true, 0.01, ""};
  controller.update(pressed);
  pressed.time = 0.06;
  EXPECT_FALSE(isZero(controller.update(pressed)));
  const ControllerOutput released = controller.update(good(0.08));
  EXPECT_EQ(released.state, ControllerState::kArmed);
  EXPECT_TRUE(isZero(released));
  EXPECT_TRUE(released.engaged());
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

TEST(Controller, AStopFromOutsideIsIdleButAfterAJumpOfTheClockAFault) {
  Running running;
  running.controller.stop("asked to", running.time() + 0.02);
  EXPECT_EQ(running.step(good(0.0)).state, ControllerState::kIdle);
  for (const double time : {1.2, -1.2, kNan}) {
    Running paused;
    paused.controller.stop("the master was silent", paused.time() + time);
    const ControllerOutput output = paused.step(good(0.0));
    EXPECT_EQ(output.state, ControllerState::kFault) << time;
    EXPECT_NE(output.reason.find("clock jumped"), std::string::npos) << output.reason;
    EXPECT_TRUE(isZero(output)) << time;
    paused.controller.stop("again", paused.time());
    EXPECT_EQ(paused.step(good(0.0)).state, ControllerState::kFault) << "it is for somebody to look at";
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

}  // namespace
}  // namespace laparoscope_servo::servo
