// The task PARALLEL in the controller: what it needs, and how it goes round its circle. What comes of a whole circle
// and of the turn: parallel_simulation_test.cpp.
#include <gtest/gtest.h>

#include "laparoscope_servo/geometry/se3.h"
#include "servo/shaping/dead_zone.h"
#include "watching_task.h"

namespace laparoscope_servo::servo {
namespace {

using test::blind;
using test::good;
using test::isZero;

constexpr double kPeriod = test::WatchingTask::kPeriod;  // s

class Circling : public test::WatchingTask {
 public:
  explicit Circling(const ControllerConfig& configuration = blind())
      : WatchingTask(Task::kParallel, {0.15, -0.1}, configuration) {
    // Straight down into the body.
    Eigen::Isometry3d tip = Eigen::Isometry3d::Identity();
    tip.linear() = geometry::so3Exp({M_PI, 0.0, 0.0});
    tip.translation() = input.depth.d2 * tip.linear().col(2);
    input.depth.insertion_point_T_tip = tip;
  }
  // What the robot executes of the next command.
  scope::Velocity executed() { return afterDeadZone(step().command, config.dead_zone.width); }
  double speed() const { return config.parallel.radius * 2.0 * M_PI / config.parallel.period; }
};

TEST(ControllerPlane, NeedsTheShaftsPose) {
  Circling task;
  task.input.depth.insertion_point_T_tip.reset();
  task.controller.select(Task::kParallel);
  EXPECT_EQ(task.controller.engage(task.input), "the shaft's pose is not known, which PARALLEL needs");
  task.input.depth.problem = "tf is silent";
  EXPECT_EQ(task.controller.engage(task.input), "tf is silent") << "why it is not known";
}

// By velocities, without the law: round, back to where it began, and without spin and insertion.
TEST(ControllerPlane, GoesRoundWhateverTheErrorSays) {
  Circling task, other;
  other.input.view.error = placeError({-0.3, 0.2}, {0.0, 0.0});
  other.input.view.error.alpha = other.input.view.error.log_depth = 0.2;
  task.engage();
  other.engage();
  Eigen::Vector4d place = Eigen::Vector4d::Zero();
  double farthest = 0.0;
  const int steps = static_cast<int>(std::lround(task.config.parallel.period / kPeriod));
  for (int k = 0; k < steps; ++k) {
    const Eigen::Vector4d velocity = task.executed().vector();
    EXPECT_EQ(velocity, other.executed().vector()) << k;
    EXPECT_TRUE(velocity.tail<2>().isZero(0.0)) << velocity.transpose();
    if (k > 10) {
      EXPECT_NEAR(velocity.norm(), task.speed(), 0.02 * task.speed()) << k;
    }
    place += kPeriod * velocity;
    farthest = std::max(farthest, place.norm());
  }
  EXPECT_NEAR(farthest, 2.0 * task.config.parallel.radius, 0.1 * task.config.parallel.radius);
  EXPECT_LT(place.norm(), 0.15 * task.config.parallel.radius);
}

// Slower, on the same circle: the time counts as the speed does.
TEST(ControllerPlane, GoesSlowerWhereLessIsVisible) {
  Circling task;
  task.engage();
  const SafetyConfig& safety = task.config.safety;
  task.input.view.visible_fraction = 0.5 * (safety.slow_below + safety.hold_below);
  Eigen::Vector4d place = Eigen::Vector4d::Zero();
  double farthest = 0.0;
  const int steps = static_cast<int>(std::lround(2.0 * task.config.parallel.period / kPeriod));
  for (int k = 0; k < steps; ++k) {
    const Eigen::Vector4d velocity = task.executed().vector();
    EXPECT_NEAR(task.last.speed_scale, 0.5, 1e-9);
    if (k > 10) {
      EXPECT_NEAR(velocity.norm(), 0.5 * task.speed(), 0.02 * task.speed()) << k;
    }
    place += kPeriod * velocity;
    farthest = std::max(farthest, place.norm());
  }
  EXPECT_NEAR(farthest, 2.0 * task.config.parallel.radius, 0.1 * task.config.parallel.radius);
}

TEST(ControllerPlane, StandsWithTheReasonWhereNoPictureHasItsPose) {
  ControllerConfig config = blind();
  config.parallel.turns = 0.5;
  config.parallel.period = 2.0;
  Circling task(config);
  task.engage();
  task.step();  // the first step after engaging has no period
  for (int k = 0; k < 45; ++k) {
    task.step();
    EXPECT_FALSE(isZero(task.last)) << k;
  }
  for (int k = 0; k < 10; ++k) task.step();
  EXPECT_EQ(task.last.state, ControllerState::kHold);
  EXPECT_TRUE(isZero(task.last));
  EXPECT_NE(task.last.reason.find("normal did not become known"), std::string::npos) << task.last.reason;
  task.controller.disengage("asked for");
  task.step();
  EXPECT_EQ(task.controller.engage(task.input), "") << "what has failed counts until somebody engages again";
  for (int k = 0; k < 3; ++k) task.step();
  EXPECT_FALSE(isZero(task.last));
}

TEST(ControllerPlane, BeginsItsCircleAlsoWhereItIsSelectedWhileEngaged) {
  Circling task;
  ASSERT_EQ(task.controller.engage(good(0.0)), "");
  task.controller.select(Task::kParallel);
  task.step();
  EXPECT_TRUE(isZero(task.last)) << "another task begins from rest";
  for (int k = 0; k < 10; ++k) task.step();
  EXPECT_EQ(task.last.state, ControllerState::kServo) << task.last.reason;
  EXPECT_GT(task.last.command.pan, 0.5 * task.speed());
  EXPECT_EQ(task.controller.figures().parallel.stage, ParallelStage::kCircle);
}

// A circle that was left is not gone on with: the next one begins with pan, as each does.
TEST(ControllerPlane, ACircleThatIsLeftBeginsAnew) {
  Circling task;
  task.engage();
  for (double end = 0.25 * task.config.parallel.period; task.time < end;) task.step();
  EXPECT_GT(task.executed().tilt, 0.9 * task.speed());
  task.controller.disengage("asked for");
  task.step();
  EXPECT_EQ(task.controller.figures().parallel.stage, ParallelStage::kUnknown);
  task.engage();
  for (int k = 0; k < 10; ++k) task.step();
  EXPECT_GT(task.last.command.pan, 0.9 * task.speed());
  EXPECT_LT(std::abs(task.executed().tilt), 0.5 * task.speed());
}

}  // namespace
}  // namespace laparoscope_servo::servo
