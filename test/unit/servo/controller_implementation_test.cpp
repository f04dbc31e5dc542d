// How the parts of the controller act on each other: what the budget of the effect guard leaves of the motion, what the
// task MANUAL needs, and what another task takes along.
#include <gtest/gtest.h>

#include "controller_input.h"
#include "servo/shaping/dead_zone.h"

namespace laparoscope_servo::servo {
namespace {

using test::blind;
using test::good;
using test::isZero;

constexpr double kPeriod = 0.02;  // s

// Engaged, with task errors whose images have no time: the guard of effect sees nothing of them.
class Unseen {
 public:
  explicit Unseen(const ControllerConfig& configuration) : config(configuration), controller(config) {
    EXPECT_EQ(controller.engage(good(0.0)), "");
  }
  ControllerOutput step(const std::function<void(ControllerInput&)>& change = nullptr) {
    ControllerInput input = good(time += kPeriod);
    if (change) change(input);
    last = controller.update(input);
    moved += kPeriod * afterDeadZone(last.command, config.dead_zone.width).vector();
    return last;
  }
  ControllerConfig config;
  Controller controller;
  ControllerOutput last;
  Eigen::Vector4d moved = Eigen::Vector4d::Zero();
  double time = 0.0;
};

TEST(ControllerImplementation, StandsBeforeItsUnseenTurnIsUsedUp) {
  Unseen loop{ControllerConfig()};
  for (int k = 0; k < 200 && loop.step().state == ControllerState::kServo; ++k) {
  }
  EXPECT_EQ(loop.last.state, ControllerState::kHold);
  EXPECT_TRUE(isZero(loop.last));
  EXPECT_NE(loop.last.reason.find("has not yet shown"), std::string::npos) << loop.last.reason;
  const double turned = loop.moved.head<2>().norm();
  EXPECT_LE(turned, loop.config.effect.unconfirmed_turn);
  EXPECT_GT(turned, 0.8 * loop.config.effect.unconfirmed_turn);
}

TEST(ControllerImplementation, GoesOnUnseenWhereNothingWatches) {
  Unseen loop(blind());
  for (int k = 0; k < 200; ++k) ASSERT_EQ(loop.step().state, ControllerState::kServo) << k;
  EXPECT_GT(loop.moved.head<2>().norm(), 2.0 * loop.config.effect.unconfirmed_turn);
}

// The way until its effect is seen may be half of what is allowed: 0.1 s after the delay.
TEST(ControllerImplementation, GoesInNoFasterThanItsEffectCanBeSeen) {
  const auto deep = [](ControllerInput& input) {
    input.task_error.error.x = input.task_error.error.y = input.task_error.error.alpha = 0.0;
    input.task_error.error.log_depth = 0.8;
  };
  Unseen watched{ControllerConfig()}, unwatched(blind());
  double fastest = 0.0, fastest_unwatched = 0.0;
  for (int k = 0; k < 25; ++k) {
    fastest = std::max(fastest, std::abs(watched.step(deep).command.insertion));
    fastest_unwatched = std::max(fastest_unwatched, std::abs(unwatched.step(deep).command.insertion));
  }
  const double allowed = 0.5 * watched.config.effect.unconfirmed_insertion / (watched.controller.figures().delay + 0.1);
  EXPECT_LE(fastest, allowed + watched.config.dead_zone.width.insertion);
  EXPECT_GT(fastest, 0.5 * allowed);
  EXPECT_GT(fastest_unwatched, 1.5 * fastest);
}

// Neither tracker nor images count in MANUAL; the pose and the robot do.
TEST(ControllerImplementation, ManualNeedsNoTrackerButEverythingElse) {
  Controller controller{ControllerConfig()};
  controller.select(Task::kManual);
  ControllerInput input = good(0.0);
  input.task_error = TaskErrorInput();
  EXPECT_EQ(controller.problem(input), "");
  input.depth.problem = "tf is silent";
  EXPECT_EQ(controller.problem(input), "tf is silent");
  input = good(0.0);
  input.robot = RobotFacts();
  EXPECT_NE(controller.problem(input), "");
}

TEST(ControllerImplementation, AnotherTaskBeginsFromRestAndTheSameOneChangesNothing) {
  Unseen loop(blind());
  for (int k = 0; k < 50; ++k) loop.step();
  ASSERT_FALSE(isZero(loop.last));
  loop.controller.select(Task::kHoldView);
  EXPECT_FALSE(isZero(loop.step())) << "the present one";
  const auto as_position = [](ControllerInput& input) { input.position = input.task_error; };
  loop.controller.select(Task::kPosition);
  EXPECT_TRUE(isZero(loop.step(as_position)));
  EXPECT_EQ(loop.last.task, Task::kPosition);
  EXPECT_EQ(loop.last.state, ControllerState::kServo) << "it is engaged as before";
  const scope::Velocity first = loop.step(as_position).command;
  EXPECT_FALSE(isZero(loop.last));
  const Eigen::Vector4d largest =
      kPeriod * loop.config.limits.acceleration.vector() + loop.config.dead_zone.width.vector();
  EXPECT_TRUE((first.vector().cwiseAbs().array() <= largest.array() + 1e-12).all()) << first.vector().transpose();
}

}  // namespace
}  // namespace laparoscope_servo::servo
