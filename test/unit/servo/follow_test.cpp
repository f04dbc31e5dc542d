// The tasks FOLLOW and POINTS: which degrees of freedom they use, and each way in which they stand.
#include <gtest/gtest.h>

#include "watching_task.h"

namespace laparoscope_servo::servo {
namespace {

using test::blind;
using test::good;
using test::isZero;
using test::kNan;

class Engaged : public test::WatchingTask {
 public:
  explicit Engaged(Task chosen) : WatchingTask(chosen, {0.15, -0.1}) { engage(); }
};

TEST(Follow, UsesPanAndTiltAlone) {
  Engaged engaged(Task::kFollow);
  engaged.seen().error.log_depth = 0.2;
  engaged.seen().error.alpha = 0.2;
  ControllerOutput last;
  for (int k = 0; k < 20; ++k) last = engaged.step();
  EXPECT_EQ(last.state, ControllerState::kServo) << last.reason;
  EXPECT_GT(last.command.pan, 0.01);
  EXPECT_GT(last.command.tilt, 0.01) << "up is minus y, and a positive tilt";
  EXPECT_EQ(last.command.spin, 0.0);
  EXPECT_EQ(last.command.insertion, 0.0);
}

TEST(Points, UsesAllDegreesOfFreedom) {
  Engaged engaged(Task::kPoints);
  engaged.seen().error.log_depth = 0.2;
  engaged.seen().error.alpha = 0.2;
  ControllerOutput last;
  for (int k = 0; k < 20; ++k) last = engaged.step();
  EXPECT_EQ(last.state, ControllerState::kServo) << last.reason;
  EXPECT_TRUE((last.command.vector().array() != 0.0).all()) << last.command.vector().transpose();
}

struct Loss {
  const char* name;
  std::function<void(TaskErrorInput&)> apply;
  const char* reason;
};

TEST(FollowAndPoints, EachLossIsAHoldAndThenLost) {
  const Loss losses[] = {
      {"nothing came", [](TaskErrorInput& seen) { seen = TaskErrorInput(); }, "no task error"},
      {"gone", [](TaskErrorInput& seen) { seen.valid = false; }, "not valid"},
      {"lost for good", [](TaskErrorInput& seen) { seen.problem = "the object was lost"; }, "the object was lost"},
      {"uncertain", [](TaskErrorInput& seen) { seen.corner_error = 8.1; }, "/max_error"},
      {"silent", [](TaskErrorInput& seen) { seen.age = 0.26; }, "silent"},
      {"old image", [](TaskErrorInput& seen) { seen.image_age = 0.26; }, "older"},
      {"not a number", [](TaskErrorInput& seen) { seen.error.y = kNan; }, "not finite"},
  };
  for (const Task task : {Task::kFollow, Task::kPoints}) {
    for (const Loss& loss : losses) {
      Engaged engaged(task);
      ControllerOutput last;
      for (int k = 0; k < 20; ++k) last = engaged.step();
      ASSERT_FALSE(isZero(last)) << loss.name;
      loss.apply(engaged.seen());
      last = engaged.step();
      EXPECT_EQ(last.state, ControllerState::kHold) << loss.name;
      EXPECT_TRUE(isZero(last)) << loss.name;
      EXPECT_NE(last.reason.find(loss.reason), std::string::npos) << loss.name << ": " << last.reason;
      for (int k = 0; k < 110; ++k) last = engaged.step();
      EXPECT_EQ(last.state, ControllerState::kLost) << loss.name;
    }
  }
}

TEST(FollowAndPoints, OtherTasksInputsDoNotCount) {
  for (const Task task : kTasks) {
    if (task == Task::kManual) continue;
    Controller controller(blind());
    controller.select(task);
    ControllerInput input = good(0.0);
    input.depth.insertion_point_T_tip = Eigen::Isometry3d::Identity();  // PARALLEL needs it
    const TaskErrorInput seen = input.task_error;
    for (const Task other : kTasks) input.seenBy(other) = other == task ? TaskErrorInput() : seen;
    input.seenBy(task) = TaskErrorInput();
    EXPECT_NE(controller.engage(input), "");
    input.seenBy(task) = seen;
    EXPECT_EQ(controller.engage(input), "");
  }
}

}  // namespace
}  // namespace laparoscope_servo::servo
