// The task CENTRE_TIP: when it moves, and each way in which it stands.
#include <gtest/gtest.h>

#include "watching_task.h"

namespace laparoscope_servo::servo {
namespace {

using test::blind;
using test::isZero;
using test::kNan;

const Eigen::Vector2d kOutside(0.25, -0.1);  // of the zone, and not so far that it leaves

class Centring : public test::WatchingTask {
 public:
  Centring() : WatchingTask(Task::kCentreTip, {0.0, 0.0}) { engage(); }
  // Whether it has moved meanwhile.
  bool movesIn(double seconds) {
    bool moves = false;
    for (const double end = time + seconds; time < end;) moves |= !isZero(step());
    return moves;
  }
};

TEST(CentreTip, NothingMovesWithinTheZone) {
  Centring task;
  for (const Eigen::Vector2d& tip : {Eigen::Vector2d(0.0, 0.0), {0.14, 0.0}, {-0.1, 0.1}, {0.0, -0.145}}) {
    task.seeAt(tip);
    EXPECT_FALSE(task.movesIn(3.0)) << tip.transpose();
    EXPECT_EQ(task.last.state, ControllerState::kServo);
  }
}

// The first half second shows that the hand is still; then pan and tilt alone, until the tip is well within the zone.
TEST(CentreTip, BringsBackATipThatIsHeldStillOutside) {
  Centring task;
  task.seeAt(kOutside);
  EXPECT_FALSE(task.movesIn(0.45));
  EXPECT_TRUE(task.movesIn(0.3));
  for (int k = 0; k < 20; ++k) task.step();
  EXPECT_GT(task.last.command.pan, 0.01);
  EXPECT_LT(task.last.command.tilt * kOutside.y(), 0.0) << "as in HOLD_VIEW: up is minus y, and a positive tilt";
  EXPECT_EQ(task.last.command.spin, 0.0);
  EXPECT_EQ(task.last.command.insertion, 0.0);
  task.seeAt({0.13, 0.0});  // in the zone, not yet within its inner part: the scope goes on
  EXPECT_TRUE(task.movesIn(0.2));
  task.seeAt({0.05, 0.0});
  task.movesIn(0.1);
  EXPECT_FALSE(task.movesIn(1.0)) << "within the inner part it stops";
  task.seeAt({0.13, 0.0});
  EXPECT_FALSE(task.movesIn(1.0)) << "and it stays so up to the zone's border";
}

TEST(CentreTip, ATipAtWorkIsNotFollowed) {
  Centring task;
  for (int k = 0; k < 200; ++k) {
    task.seeAt(kOutside + Eigen::Vector2d(0.0, k % 20 < 10 ? 0.03 : 0.0));  // 12 px to and fro, at 2.5 Hz
    EXPECT_TRUE(isZero(task.step())) << k;
  }
}

struct Loss {
  const char* name;
  std::function<void(TaskErrorInput&)> apply;
  const char* reason;
};

TEST(CentreTip, EachLossOfTheTipIsAHold) {
  const Loss losses[] = {
      {"nothing came", [](TaskErrorInput& tip) { tip = TaskErrorInput(); }, "no task error"},
      {"gone", [](TaskErrorInput& tip) { tip.valid = false; }, "not valid"},
      {"leaves", [](TaskErrorInput& tip) { tip.error.x = 0.51; }, "the tip leaves"},
      {"uncertain", [](TaskErrorInput& tip) { tip.corner_error = 4.1; }, "centre_tip/max_error"},
      {"silent", [](TaskErrorInput& tip) { tip.age = 0.26; }, "silent"},
      {"old image", [](TaskErrorInput& tip) { tip.image_age = 0.26; }, "older"},
      {"not a number", [](TaskErrorInput& tip) { tip.error.y = kNan; }, "not finite"},
  };
  for (const Loss& loss : losses) {
    Centring task;
    task.seeAt(kOutside);
    ASSERT_TRUE(task.movesIn(1.0)) << loss.name;
    loss.apply(task.input.tip);
    task.step();
    EXPECT_EQ(task.last.state, ControllerState::kHold) << loss.name;
    EXPECT_TRUE(isZero(task.last)) << loss.name;
    EXPECT_NE(task.last.reason.find(loss.reason), std::string::npos) << loss.name << ": " << task.last.reason;
    task.movesIn(2.2);
    EXPECT_EQ(task.last.state, ControllerState::kLost) << loss.name;
  }
}

TEST(CentreTip, AfterAHoldTheTipHasToBeStillAgain) {
  Centring task;
  task.seeAt(kOutside);
  ASSERT_TRUE(task.movesIn(1.0));
  task.input.tip.valid = false;
  task.step();
  task.input.tip.valid = true;
  EXPECT_FALSE(task.movesIn(0.45));
  EXPECT_TRUE(task.movesIn(0.3));
}

// Bands that change while it runs are those of the other tasks.
TEST(CentreTip, TheZoneStaysWhenBandsAreRetuned) {
  Centring task;
  ControllerConfig config = blind();
  config.rest.centre_start = 0.002;
  task.controller.retune(config);
  task.seeAt({0.14, 0.0});
  EXPECT_FALSE(task.movesIn(2.0));
}

}  // namespace
}  // namespace laparoscope_servo::servo
