// Manual drive: four velocities instead of a law, the same safety states.
#include <gtest/gtest.h>

#include "controller_input.h"

namespace laparoscope_servo::servo {
namespace {

using test::isZero;
using test::kInfinity;
using test::kNan;

// No tracker; whoever drives turns to the right and goes deeper.
ControllerInput driven(double time) {
  ControllerInput input;
  input.time = time;
  input.robot = {"", true, 0.1};
  input.depth.problem.clear();
  input.depth.d2 = 0.1;
  input.depth.lateral_offset = 0.001;
  input.depth.age = 0.02;
  input.manual.velocity = {0.05, 0.0, 0.0, 0.01};
  input.manual.age = 0.01;
  return input;
}

// The stick is let go.
ControllerInput released(double time) {
  ControllerInput input = driven(time);
  input.manual.velocity = scope::Velocity();
  return input;
}

ControllerInput tracked(double time) {
  ControllerInput input = driven(time);
  input.task_error.problem.clear();
  input.task_error.valid = true;
  input.task_error.error.x = -0.2;
  input.task_error.age = 0.02;
  input.task_error.image_age = 0.05;
  input.task_error.visible_fraction = 1.0;
  input.task_error.corner_error = 0.1;
  return input;
}

// Has been driven since time 0, and steps on.
class Driving {
 public:
  explicit Driving(const ControllerConfig& config = ControllerConfig()) : controller(config) {
    controller.select(Task::kManual);
    EXPECT_EQ(controller.engage(released(0.0)), "");
    for (int k = 0; k < 2; ++k) step(released(0.0));
    for (int k = 0; k < 25; ++k) step(driven(0.0));
    EXPECT_EQ(last.state, ControllerState::kServo);
    EXPECT_GT(last.command.pan, 0.05);
  }
  ControllerOutput step(ControllerInput input) {
    time += 0.02;
    input.time = time;
    return last = controller.update(input);
  }

  Controller controller;
  ControllerOutput last;
  double time = 0.0;
};

TEST(ManualDrive, HoldingTheViewIsTheTaskAtFirst) {
  Controller controller{ControllerConfig()};
  EXPECT_EQ(controller.task(), Task::kHoldView);
  EXPECT_NE(controller.engage(driven(0.0)), "");  // it needs a tracker
  EXPECT_EQ(controller.update(tracked(0.02)).task, Task::kHoldView);
}

TEST(ManualDrive, GoesWhereItIsDrivenWithoutATracker) {
  const Driving driving;
  const DeadZoneConfig dead_zone;
  EXPECT_EQ(driving.last.task, Task::kManual);
  EXPECT_NEAR(driving.last.command.pan, 0.05 + dead_zone.width.pan, 1e-12);
  EXPECT_NEAR(driving.last.command.insertion, 0.01 + dead_zone.width.insertion, 1e-12);
  EXPECT_EQ(driving.last.command.tilt, 0.0);
  EXPECT_EQ(driving.last.command.spin, 0.0);
  EXPECT_EQ(driving.last.caution, "");
}

TEST(ManualDrive, KeepsItsLimits) {
  Driving driving;
  const Limits limits;
  for (const double size : {1.0, 1e300}) {
    ControllerInput fast = driven(0.0);
    fast.manual.velocity = {size, -size, size, -size};
    for (int k = 0; k < 50; ++k) {
      const Eigen::Vector4d before = driving.last.command.vector();
      const Eigen::Vector4d command = driving.step(fast).command.vector();
      EXPECT_TRUE((command.cwiseAbs().array() <= limits.velocity.vector().array() * (1.0 + 1e-9)).all());
      const Eigen::Vector4d change = 0.02 * limits.acceleration.vector() + 2.0 * DeadZoneConfig().width.vector();
      EXPECT_TRUE(((command - before).cwiseAbs().array() <= change.array() * (1.0 + 1e-9)).all());
    }
    EXPECT_GT(driving.last.command.pan, 0.0);
  }
}

TEST(ManualDrive, WhateverTheTrackerSaysDoesNotCount) {
  Driving driving;
  ControllerInput input = tracked(0.0);
  input.task_error.error.x = kNan;
  EXPECT_FALSE(isZero(driving.step(input)));
  input.task_error.valid = false;
  input.task_error.visible_fraction = 0.0;
  input.task_error.corner_error = kInfinity;
  EXPECT_FALSE(isZero(driving.step(input)));
  EXPECT_EQ(driving.last.speed_scale, 1.0);
  EXPECT_GT(driving.last.command.insertion, 0.0);
  EXPECT_EQ(driving.last.caution, "");
}

TEST(ManualDrive, SilenceIsStandstillWithoutAHold) {
  for (const double age : {0.21, 100.0, -0.1, kNan, kInfinity}) {
    Driving driving;
    ControllerInput silent = driven(0.0);
    silent.manual.age = age;
    for (int k = 0; k < 200; ++k) {  // longer than any hold lasts
      EXPECT_TRUE(isZero(driving.step(silent))) << age;
      EXPECT_EQ(driving.last.state, ControllerState::kServo) << age;
    }
    EXPECT_NE(driving.last.caution.find("manual command"), std::string::npos) << driving.last.caution;
    EXPECT_TRUE(isZero(driving.step(driven(0.0)))) << "it came back deflected";
    EXPECT_NE(driving.last.caution.find("release the stick"), std::string::npos) << driving.last.caution;
    EXPECT_TRUE(isZero(driving.step(released(0.0))));
    EXPECT_FALSE(isZero(driving.step(driven(0.0))));
    EXPECT_LT(driving.last.command.pan, 0.03) << "starts from rest";
  }
}

TEST(ManualDrive, AStickThatTremblesAboutItsRestIsStandstill) {
  Driving driving;
  for (int k = 0; k < 300; ++k) {
    ControllerInput trembling = released(0.0);
    trembling.manual.velocity = {0.0012 + 1e-5 * (k % 7), 0.0, -0.0019, 0.0003};
    const bool stands = isZero(driving.step(trembling));
    ASSERT_TRUE(stands || k < 50) << k;
  }
  EXPECT_GT(driving.step(driven(0.0)).command.pan, 0.0);
}

TEST(ManualDrive, WhatIsNotFiniteIsStandstill) {
  for (const double bad : {kNan, kInfinity, -kInfinity}) {
    for (int axis = 0; axis < 4; ++axis) {
      Driving driving;
      ControllerInput input = driven(0.0);
      Eigen::Vector4d velocity = input.manual.velocity.vector();
      velocity[axis] = bad;
      input.manual.velocity = scope::Velocity::fromVector(velocity);
      EXPECT_TRUE(isZero(driving.step(input)));
      EXPECT_EQ(driving.last.state, ControllerState::kServo);
      EXPECT_NE(driving.last.caution.find("not finite"), std::string::npos) << driving.last.caution;
      EXPECT_TRUE(isZero(driving.step(released(0.0))));
      EXPECT_FALSE(isZero(driving.step(driven(0.0))));
    }
  }
}

TEST(ManualDrive, TheSafetyStatesAreTheSame) {
  const auto expect = [](const std::function<void(ControllerInput&)>& change, ControllerState state) {
    ControllerConfig config;
    config.safety.robot_required = config.safety.dead_man_required = true;
    Controller controller(config);
    controller.select(Task::kManual);
    ControllerInput input = driven(0.0);
    input.robot = {"", true, 0.1};
    input.dead_man = {true, 0.01, ""};
    ASSERT_EQ(controller.engage(input), "");
    input.time = 0.02;
    input.manual.velocity = scope::Velocity();
    ASSERT_EQ(controller.update(input).state, ControllerState::kServo);
    input.time = 0.03;
    controller.update(input);
    input.time = 0.04;
    input.manual.velocity = driven(0.0).manual.velocity;
    ASSERT_FALSE(isZero(controller.update(input)));
    input.time = 0.06;
    change(input);
    const ControllerOutput output = controller.update(input);
    EXPECT_EQ(output.state, state) << output.reason;
    EXPECT_TRUE(isZero(output)) << output.reason;
  };
  expect([](ControllerInput& i) { i.dead_man.pressed = false; }, ControllerState::kArmed);
  expect([](ControllerInput& i) { i.dead_man.age = 0.3; }, ControllerState::kArmed);
  expect([](ControllerInput& i) { i.robot.enabled = false; }, ControllerState::kLost);
  expect([](ControllerInput& i) { i.robot.enabled = false, i.robot.paused = true; }, ControllerState::kHold);
  expect([](ControllerInput& i) { i.ended = "/aesop has connected anew"; }, ControllerState::kLost);
  expect([](ControllerInput& i) { i.robot.age = 1.0; }, ControllerState::kHold);
  expect([](ControllerInput& i) { i.depth.age = 0.3; }, ControllerState::kHold);
  expect([](ControllerInput& i) { i.depth.d2 = 0.3; }, ControllerState::kHold);
  expect([](ControllerInput& i) { i.depth.lateral_offset = 0.03; }, ControllerState::kFault);
  expect([](ControllerInput& i) { i.clock_jump = "ROS time jumped back"; }, ControllerState::kFault);
}

TEST(ManualDrive, AnArmThatGoesTheOtherWayIsAFault) {
  Driving driving;
  ControllerInput input = driven(0.0);
  input.robot_report = {true, 0.0, {-0.05, 0.0, 0.0, 0.0}};
  for (int k = 0; k < 20; ++k) driving.step(input);  // 1.1 degrees
  EXPECT_EQ(driving.last.state, ControllerState::kFault);
  EXPECT_NE(driving.last.reason.find("pan goes against what it is told"), std::string::npos) << driving.last.reason;
}

TEST(ManualDrive, AnotherTaskStartsFromRest) {
  const Eigen::Vector4d first = 0.02 * Limits().acceleration.vector() + DeadZoneConfig().width.vector();
  Driving driving;
  for (const Task task : {Task::kHoldView, Task::kManual}) {
    // Not for longer: here the picture shows nothing of the motion.
    for (int k = 0; k < 15; ++k) driving.step(tracked(0.0));
    EXPECT_FALSE(isZero(driving.last));
    driving.controller.select(task);
    EXPECT_TRUE(isZero(driving.step(tracked(0.0))));
    EXPECT_EQ(isZero(driving.step(tracked(0.0))), task == Task::kManual) << "the stick was held";
    if (task == Task::kManual) {
      EXPECT_NE(driving.last.caution.find("release the stick"), std::string::npos) << driving.last.caution;
      ControllerInput let_go = tracked(0.0);
      let_go.manual.velocity = scope::Velocity();
      EXPECT_TRUE(isZero(driving.step(let_go)));
      driving.step(tracked(0.0));
    }
    EXPECT_EQ(driving.last.state, ControllerState::kServo);
    EXPECT_EQ(driving.last.task, task);
    EXPECT_FALSE(isZero(driving.last));
    EXPECT_EQ(driving.last.command.pan > 0.0, task == Task::kManual);  // the target is on the left
    EXPECT_TRUE((driving.last.command.vector().cwiseAbs().array() <= first.array() * (1.0 + 1e-9)).all());
  }
}

TEST(ManualDrive, TheSameTaskAgainChangesNothing) {
  Driving driving, twin;
  driving.controller.select(Task::kManual);
  EXPECT_EQ(driving.step(driven(0.0)).command.vector(), twin.step(driven(0.0)).command.vector());
}

TEST(ManualDrive, ATaskThatMissesSomethingHolds) {
  Driving driving;
  driving.controller.select(Task::kHoldView);
  EXPECT_EQ(driving.step(driven(0.0)).state, ControllerState::kHold);  // no tracker
  EXPECT_TRUE(isZero(driving.last));
  driving.controller.select(Task::kManual);
  EXPECT_TRUE(isZero(driving.step(driven(0.0))));
  EXPECT_TRUE(isZero(driving.step(released(0.0))));
  EXPECT_FALSE(isZero(driving.step(driven(0.0))));
}

// The stick is deflected while the scope may not move, and still is when it may again.
TEST(ManualDrive, AStickThatIsHeldSetsNothingInMotion) {
  const std::vector<std::function<void(ControllerInput&)>> holds{
      [](ControllerInput& i) { i.depth.age = 0.3; },
      [](ControllerInput& i) { i.robot.enabled = false, i.robot.paused = true; }};
  for (const auto& hold : holds) {
    Driving driving;
    ControllerInput input = driven(0.0);
    hold(input);
    EXPECT_EQ(driving.step(input).state, ControllerState::kHold);
    for (int k = 0; k < 100; ++k) EXPECT_TRUE(isZero(driving.step(driven(0.0))));
    EXPECT_EQ(driving.last.state, ControllerState::kServo);
    EXPECT_NE(driving.last.caution.find("release the stick"), std::string::npos) << driving.last.caution;
    driving.step(released(0.0));
    EXPECT_FALSE(isZero(driving.step(driven(0.0))));
  }
  Driving engaging;
  engaging.controller.disengage("not engaged");
  EXPECT_EQ(engaging.controller.engage(driven(engaging.time)), "");
  for (int k = 0; k < 100; ++k) EXPECT_TRUE(isZero(engaging.step(driven(0.0))));
}

TEST(ManualDrive, APadOutOfReachStops) {
  Driving driving;
  int moved = 0;
  for (int k = 0; k < 500; ++k) moved += isZero(driving.step(driven(0.0))) ? 0 : 1;  // 10 s
  EXPECT_LT(moved, 251);
  EXPECT_NE(driving.last.caution.find("same to the last digit"), std::string::npos) << driving.last.caution;
}

TEST(ManualDrive, SelectingATaskSetsNothingInMotion) {
  Controller controller{ControllerConfig()};
  controller.select(Task::kManual);
  for (int k = 0; k < 10; ++k) EXPECT_TRUE(isZero(controller.update(driven(0.02 * k))));
  // Nor does it clear a fault.
  Driving driving;
  ControllerInput jump = driven(0.0);
  jump.clock_jump = "ROS time jumped back";
  driving.step(jump);
  driving.controller.select(Task::kHoldView);
  driving.controller.select(Task::kManual);
  EXPECT_EQ(driving.step(driven(0.0)).state, ControllerState::kFault);
  EXPECT_TRUE(isZero(driving.last));
}

}  // namespace
}  // namespace laparoscope_servo::servo
