// The task STABILISE: which input it goes by, what it moves, and each way in which it stands.
#include <gtest/gtest.h>

#include "controller_input.h"

namespace laparoscope_servo::servo {
namespace {

using test::blind;
using test::good;
using test::isZero;
using test::kInfinity;
using test::kNan;

// The view is off in all four features; the region of interest says nothing.
ControllerInput viewed(double time) {
  ControllerInput input = good(time);
  input.view = input.task_error;
  input.view.image_time = time - 0.05;
  input.view.region = 7.0;
  input.task_error = TaskErrorInput();
  return input;
}

// Has stabilised since time 0.
class Stabilising {
 public:
  explicit Stabilising(const ControllerConfig& config = ControllerConfig()) : controller(blind(config)) {
    controller.select(Task::kStabilise);
    EXPECT_EQ(controller.engage(viewed(0.0)), "");
    for (int k = 0; k < 50; ++k) step(viewed(0.0));
    EXPECT_EQ(last.state, ControllerState::kServo);
    EXPECT_GT(last.command.pan, 0.01);
  }
  ControllerOutput step(ControllerInput input) {
    time += 0.02;
    input.time = time;
    if (input.view.image_time) input.view.image_time = time - 0.05;
    input.view.error.x += 1e-9 * time;  // no two pictures are the same
    return last = controller.update(input);
  }
  Controller controller;
  ControllerOutput last;
  double time = 0.0;
};

TEST(Stabilise, GoesByTheViewByPanAndTiltAlone) {
  Stabilising task;
  EXPECT_EQ(task.last.task, Task::kStabilise);
  for (int k = 0; k < 50; ++k) {
    task.step(viewed(0.0));
    EXPECT_GT(task.last.command.pan, 0.0);
    EXPECT_GT(task.last.command.tilt, 0.0);
    EXPECT_EQ(task.last.command.spin, 0.0);
    EXPECT_EQ(task.last.command.insertion, 0.0);
  }
}

TEST(Stabilise, MovesInSpinAndInsertionOnChoice) {
  ControllerConfig config;
  config.stabilise.spin = true;
  Stabilising spinning(config);
  EXPECT_NE(spinning.last.command.spin, 0.0);
  EXPECT_EQ(spinning.last.command.insertion, 0.0);
  config.stabilise.spin = false;
  config.stabilise.insertion = true;
  Stabilising inserting(config);
  EXPECT_EQ(inserting.last.command.spin, 0.0);
  EXPECT_NE(inserting.last.command.insertion, 0.0);
  config.stabilise.spin = true;
  config.spin = SpinMode::kReleased;
  Stabilising released(config);
  EXPECT_EQ(released.last.command.spin, 0.0) << "released for every task";
}

// The paper's law is one of four degrees of freedom: with it the scope would spin.
TEST(Stabilise, DoesNotUseThePapersLaw) {
  ControllerConfig config;
  config.law = LawKind::kPaper;
  const Stabilising task(config);
  EXPECT_EQ(task.last.command.spin, 0.0);
  EXPECT_EQ(task.last.command.insertion, 0.0);
}

struct Loss {
  const char* name;
  std::function<void(TaskErrorInput&)> apply;
  const char* reason;
};

TEST(Stabilise, EachLossOfTheViewIsAHoldAndGoesOnByItself) {
  const Loss losses[] = {
      {"nothing came", [](TaskErrorInput& view) { view = TaskErrorInput(); }, "no task error"},
      {"problem", [](TaskErrorInput& view) { view.problem = "no image was selected"; }, "no image was selected"},
      {"lost", [](TaskErrorInput& view) { view.valid = false; }, "not valid"},
      {"silent", [](TaskErrorInput& view) { view.age = 0.26; }, "silent"},
      {"age not a number", [](TaskErrorInput& view) { view.age = kNan; }, "silent"},
      {"old image", [](TaskErrorInput& view) { view.image_age = 0.26; }, "older"},
      {"little follows", [](TaskErrorInput& view) { view.visible_fraction = 0.1; }, "occluded"},
      {"uncertain", [](TaskErrorInput& view) { view.corner_error = 2.1; }, "stabilise/max_error"},
      {"unknown error", [](TaskErrorInput& view) { view.corner_error = kInfinity; }, "stabilise/max_error"},
      {"error not a number", [](TaskErrorInput& view) { view.corner_error = kNan; }, "corner_error"},
      {"error negative", [](TaskErrorInput& view) { view.corner_error = -0.1; }, "corner_error"},
      {"not finite", [](TaskErrorInput& view) { view.error.x = kNan; }, "not finite"},
      {"beside any camera", [](TaskErrorInput& view) { view.error.y = 100.0; }, "not within"},
  };
  Stabilising task;
  for (const Loss& loss : losses) {
    ControllerInput input = viewed(0.0);
    loss.apply(input.view);
    task.step(input);
    EXPECT_EQ(task.last.state, ControllerState::kHold) << loss.name;
    EXPECT_TRUE(isZero(task.last)) << loss.name;
    EXPECT_NE(task.last.reason.find(loss.reason), std::string::npos) << loss.name << ": " << task.last.reason;
    for (int k = 0; k < 20; ++k) task.step(viewed(0.0));
    EXPECT_EQ(task.last.state, ControllerState::kServo) << loss.name;
    EXPECT_GT(task.last.command.pan, 0.0) << loss.name;
  }
}

TEST(Stabilise, EngagesOnlyWhenTheViewIsKnown) {
  Controller controller{ControllerConfig()};
  controller.select(Task::kStabilise);
  EXPECT_NE(controller.engage(good(0.0)), "") << "a region alone is not enough";
  EXPECT_EQ(controller.engage(viewed(0.0)), "");
}

TEST(Stabilise, LostForTooLongItDisengages) {
  Stabilising task;
  ControllerInput lost = viewed(0.0);
  lost.view.valid = false;
  for (int k = 0; k < 110; ++k) EXPECT_TRUE(isZero(task.step(lost)));
  EXPECT_EQ(task.last.state, ControllerState::kLost);
  EXPECT_TRUE(isZero(task.step(viewed(0.0)))) << "it does not begin again by itself";
}

TEST(Stabilise, APictureThatRepeatsWhileTheScopeMovesIsAHold) {
  Stabilising task;
  for (int k = 0; k < 10; ++k) {
    task.time += 0.04;
    ControllerInput same = viewed(task.time);
    task.last = task.controller.update(same);
  }
  EXPECT_EQ(task.last.state, ControllerState::kHold);
  EXPECT_NE(task.last.reason.find("repeats"), std::string::npos) << task.last.reason;
}

// Both are there, and want opposite motions: each task goes by its own, from rest.
TEST(Stabilise, ATaskGoesByItsOwnInputFromRest) {
  const auto both = [] {
    ControllerInput input = viewed(0.0);
    input.task_error = good(0.0).task_error;
    input.task_error.error.x = -input.task_error.error.x;
    input.task_error.image_time.reset();
    return input;
  };
  Stabilising task;
  task.controller.select(Task::kHoldView);
  EXPECT_TRUE(isZero(task.step(both())));
  double last = 0.0;
  for (int k = 0; k < 25; ++k) {
    const double pan = task.step(both()).command.pan;
    EXPECT_LE(pan, 0.0);
    EXPECT_LT(last - pan, 0.03) << "no faster than the limit of acceleration and the inverse of the dead zone";
    last = pan;
  }
  EXPECT_LT(last, -0.01);
  EXPECT_NE(task.last.command.insertion, 0.0) << "HOLD_VIEW has all its degrees of freedom again";
  task.controller.select(Task::kStabilise);
  EXPECT_TRUE(isZero(task.step(both())));
  for (int k = 0; k < 25; ++k) EXPECT_GE(task.step(both()).command.pan, 0.0);
  EXPECT_EQ(task.last.command.insertion, 0.0);
}

TEST(Stabilise, AnotherAnchorDuringAHoldForTheArmEndsIt) {
  Stabilising task;
  ControllerInput paused = viewed(0.0);
  paused.robot.enabled = false;
  paused.robot.paused = true;
  task.step(paused);
  EXPECT_EQ(task.last.state, ControllerState::kHold);
  ControllerInput other = viewed(0.0);
  other.view.region = 8.0;
  task.step(other);
  EXPECT_EQ(task.last.state, ControllerState::kLost);
}

}  // namespace
}  // namespace laparoscope_servo::servo
