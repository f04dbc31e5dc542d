#include "laparoscope_servo/aesop/motion_delay.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <deque>

namespace laparoscope_servo::aesop {
namespace {

constexpr double kPeriod = 0.025;  // s

// An arm that does late what it is told: commands every 25 ms, each answered by a status.
class LateArm {
 public:
  LateArm(MotionDelay& delay, double late, double time_constant = 0.0)
      : delay_(delay), late_(late), time_constant_(time_constant) {}

  void run(double speed, double seconds) {
    JointVector velocity = JointVector::Zero();
    velocity[1] = speed;
    velocity[6] = -0.3 * speed;
    for (int k = 0; k < static_cast<int>(std::lround(seconds / kPeriod)); ++k) {
      delay_.sent(velocity, now_);
      commands_.emplace_back(now_ + late_, velocity);
      now_ += kPeriod;
      while (!commands_.empty() && commands_.front().first <= now_ + 1e-9) {
        target_ = commands_.front().second;
        commands_.pop_front();
      }
      const double share = time_constant_ > 0.0 ? 1.0 - std::exp(-kPeriod / time_constant_) : 1.0;
      Status status;
      velocity_ += share * (target_ - velocity_);
      if (target_.isZero(0.0) && velocity_.norm() < 1e-4) velocity_.setZero();
      status.velocity = velocity_;
      const auto moves = [](const auto& command) { return !command.second.isZero(0.0); };
      status.moving = !velocity_.isZero(0.0) || std::any_of(commands_.begin(), commands_.end(), moves);
      delay_.received(status, now_);
    }
  }

 private:
  MotionDelay& delay_;
  double late_;
  double time_constant_;
  double now_ = 100.0;
  std::deque<std::pair<double, JointVector>> commands_;
  JointVector target_ = JointVector::Zero();
  JointVector velocity_ = JointVector::Zero();
};

TEST(MotionDelay, nothingIsKnownBeforeTheFirstStep) {
  MotionDelay delay;
  LateArm arm(delay, 0.15);
  arm.run(0.0, 1.0);
  EXPECT_FALSE(delay.start());
  EXPECT_FALSE(delay.stop());
  EXPECT_FALSE(delay.standing());
}

TEST(MotionDelay, findsTheDelayOfStepsEitherWay) {
  for (const double late : {0.05, 0.15, 0.30}) {
    for (const double speed : {0.05, -0.05}) {
      MotionDelay delay;
      LateArm arm(delay, late);
      for (int k = 0; k < 3; ++k) {
        arm.run(0.0, 1.0);
        arm.run(speed, 1.0);
      }
      arm.run(0.0, 1.0);
      ASSERT_TRUE(delay.start() && delay.stop() && delay.standing());
      EXPECT_NEAR(*delay.start(), late, kPeriod + 1e-9);
      EXPECT_NEAR(*delay.stop(), late, kPeriod + 1e-9);
      EXPECT_GE(*delay.standing(), *delay.stop());
    }
  }
}

TEST(MotionDelay, standingIsLaterThanHalfTheSpeed) {
  MotionDelay delay;
  LateArm arm(delay, 0.1, 0.1);
  arm.run(0.0, 0.5);
  arm.run(0.05, 2.0);
  arm.run(0.0, 3.0);
  ASSERT_TRUE(delay.stop() && delay.standing());
  EXPECT_NEAR(*delay.stop(), 0.1 + 0.1 * std::log(2.0), 2.0 * kPeriod);
  EXPECT_GT(*delay.standing(), 0.4);
}

// A command that grows from nothing says nothing about when it was obeyed.
TEST(MotionDelay, aRampIsNoStep) {
  MotionDelay delay;
  LateArm arm(delay, 0.15);
  arm.run(0.0, 0.5);
  for (int k = 1; k <= 40; ++k) arm.run(0.001 * k, kPeriod);
  EXPECT_FALSE(delay.start());
}

// A command that ran out faded before: its last step is not when the arm was told to stop.
TEST(MotionDelay, aCommandThatFadedIsNoStep) {
  MotionDelay delay;
  LateArm arm(delay, 0.15);
  arm.run(0.0, 0.5);
  arm.run(0.05, 1.0);
  for (const double share : {0.75, 0.5, 0.25}) arm.run(0.05 * share, kPeriod);
  arm.run(0.0, 1.0);
  EXPECT_TRUE(delay.start());
  EXPECT_FALSE(delay.stop());
}

TEST(MotionDelay, aStepBeforeTheArmStandsIsNone) {
  MotionDelay delay;
  LateArm arm(delay, 0.15);
  arm.run(0.0, 0.5);
  arm.run(0.05, 0.05);  // over before it shows
  arm.run(0.0, 0.05);
  arm.run(0.05, 1.0);
  EXPECT_FALSE(delay.start());
}

TEST(MotionDelay, aLostLinkEndsWhatIsUnderWay) {
  MotionDelay delay;
  Status status;
  JointVector velocity = JointVector::Zero();
  velocity[0] = 0.01;
  delay.received(status, 0.0);
  delay.sent(velocity, 0.0);
  delay.lost();
  status.moving = true;
  status.velocity = velocity;
  delay.received(status, 60.0);
  EXPECT_FALSE(delay.start());
  delay.sent(JointVector::Zero(), 60.1);
  delay.received(Status(), 60.2);
  EXPECT_FALSE(delay.standing()) << "it did not move by our word";
}

}  // namespace
}  // namespace laparoscope_servo::aesop
