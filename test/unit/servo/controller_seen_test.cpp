// What the controller sees by each task, and when that is not enough.
#include <gtest/gtest.h>

#include "controller_input.h"
#include "laparoscope_servo/servo/place_error.h"

namespace laparoscope_servo::servo {
namespace {

using test::blind;
using test::good;
using test::kNan;

// Everything that each task needs is there.
ControllerInput allThere() {
  ControllerInput input = good(0.0);
  input.depth.insertion_point_T_tip = Eigen::Isometry3d(Eigen::Translation3d(0.0, 0.0, input.depth.d2));
  for (const Task task : kTasks) {
    input.seenBy(task) = good(0.0).task_error;
    input.seenBy(task).error = placeError({0.1, -0.05}, {0.0, 0.0});
  }
  return input;
}

std::string refusal(Task task, const ControllerConfig& config, const ControllerInput& input) {
  Controller controller(config);
  controller.select(task);
  return controller.problem(input);
}

TEST(ControllerSeen, EachTaskHasItsInput) {
  ControllerInput input;
  EXPECT_EQ(&input.seenBy(Task::kHoldView), &input.task_error);
  EXPECT_EQ(&input.seenBy(Task::kStabilise), &input.view);
  EXPECT_EQ(&input.seenBy(Task::kParallel), &input.view);
  EXPECT_EQ(&input.seenBy(Task::kCentreTip), &input.tip);
  EXPECT_EQ(&input.seenBy(Task::kFollow), &input.object);
  EXPECT_EQ(&input.seenBy(Task::kPoints), &input.points);
  EXPECT_EQ(&input.seenBy(Task::kPosition), &input.position);
  const ControllerInput& constant = input;
  for (const Task task : kTasks) EXPECT_EQ(&constant.seenBy(task), &input.seenBy(task)) << static_cast<int>(task);
}

// At its own bound the expected error is accepted, beyond it the task is refused by the name of its own parameter.
TEST(ControllerSeen, EachTaskHasItsBoundOfTheExpectedError) {
  struct Case {
    Task task;
    std::function<double&(ControllerConfig&)> bound;
    const char* parameter;
  };
  const Case cases[] = {
      {Task::kStabilise, [](ControllerConfig& c) -> double& { return c.stabilise.max_error; }, "stabilise/max_error"},
      {Task::kCentreTip, [](ControllerConfig& c) -> double& { return c.centre_tip.max_error; }, "centre_tip/max_error"},
      {Task::kFollow, [](ControllerConfig& c) -> double& { return c.follow.max_error; }, "follow/max_error"},
      {Task::kPoints, [](ControllerConfig& c) -> double& { return c.points.max_error; }, "points/max_error"},
      {Task::kParallel, [](ControllerConfig& c) -> double& { return c.parallel.max_error; }, "parallel/max_error"}};
  ControllerConfig config = blind();
  double bound = 3.0;
  for (const Case& each : cases) each.bound(config) = bound += 1.0;
  for (const Case& each : cases) {
    ControllerInput input = allThere();
    input.seenBy(each.task).corner_error = each.bound(config);
    EXPECT_EQ(refusal(each.task, config, input), "") << each.parameter;
    input.seenBy(each.task).corner_error = each.bound(config) + 1e-6;
    EXPECT_NE(refusal(each.task, config, input).find(each.parameter), std::string::npos) << each.parameter;
    input.seenBy(each.task).corner_error = kNan;
    EXPECT_NE(refusal(each.task, config, input), "") << each.parameter;
  }
}

// A tip leaves by its distance from the zone's middle, which need not be that of the image.
TEST(ControllerSeen, ATipLeavesByItsDistanceFromTheZone) {
  ControllerConfig config = blind();
  config.centre_tip.x = 0.2;
  config.centre_tip.y = -0.1;
  config.centre_tip.leave = 0.3;
  for (const Eigen::Vector2d& way : {Eigen::Vector2d(1.0, 0.0), {0.0, -1.0}, {-0.6, 0.8}}) {
    ControllerInput input = allThere();
    input.tip.error = placeError(Eigen::Vector2d(0.2, -0.1) + 0.299 * way, {0.2, -0.1});
    EXPECT_EQ(refusal(Task::kCentreTip, config, input), "") << way.transpose();
    input.tip.error = placeError(Eigen::Vector2d(0.2, -0.1) + 0.301 * way, {0.2, -0.1});
    EXPECT_NE(refusal(Task::kCentreTip, config, input).find("centre_tip/leave"), std::string::npos) << way.transpose();
  }
}

// What is impossible is refused in every task that follows a picture; MANUAL looks at none.
TEST(ControllerSeen, WhatCannotBeIsRefusedInEachTask) {
  for (const Task task : kTasks) {
    ControllerInput input = allThere();
    ASSERT_EQ(refusal(task, blind(), input), "") << static_cast<int>(task);
    input.seenBy(task).error.x = 100.0;
    EXPECT_EQ(refusal(task, blind(), input).empty(), task == Task::kManual) << static_cast<int>(task);
  }
}

}  // namespace
}  // namespace laparoscope_servo::servo
