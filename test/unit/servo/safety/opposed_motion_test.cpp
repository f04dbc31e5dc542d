#include "servo/safety/opposed_motion.h"

#include <gtest/gtest.h>

#include <cmath>

namespace laparoscope_servo::servo {
namespace {

constexpr double kStep = 0.02;   // s
constexpr double kDelay = 0.16;  // s, as it is believed

class Arm {
 public:
  // Told to move for `seconds`; it does so after `delay`, times `sign`.
  void run(const scope::Velocity& velocity, double seconds, double sign, double delay = kDelay) {
    for (const double end = time_ + seconds - 1e-9; time_ < end; time_ += kStep) {
      told_.add(time_, velocity);
      watch.report(time_, scope::Velocity::fromVector(sign * told_.velocity(time_, delay)), told_, kDelay);
    }
  }

  OpposedMotion watch{scope::Velocity{0.004, 0.004, 0.004, 0.0004}};

 private:
  CommandHistory told_{5.0, 0.2};
  double time_ = 0.0;
};

TEST(OpposedMotion, AnArmThatDoesWhatItIsToldIsNotOpposed) {
  for (const double delay : {0.1, 0.16, 0.24}) {
    Arm arm;
    for (const double sign : {1.0, -1.0, 1.0})
      arm.run({sign * 0.1, sign * 0.05, -sign * 0.1, sign * 0.01}, 0.6, 1.0, delay);
    EXPECT_EQ(arm.watch.words(), "") << delay;
  }
}

TEST(OpposedMotion, NamesTheAxisThatGoesTheWrongWayUntilItIsRestarted) {
  const scope::Velocity motions[] = {
      {0.1, 0.0, 0.0, 0.0}, {0.0, 0.1, 0.0, 0.0}, {0.0, 0.0, 0.1, 0.0}, {0.0, 0.0, 0.0, 0.01}};
  const char* const names[] = {"pan", "tilt", "spin", "insertion"};
  for (int k = 0; k < 4; ++k) {
    Arm arm;
    arm.run(motions[k], 0.26, -1.0);
    EXPECT_EQ(arm.watch.words(), "") << "too early to tell";
    arm.run(motions[k], 0.24, -1.0);
    EXPECT_EQ(arm.watch.words(), std::string("the robot says that its ") + names[k] + " goes against what it is told");
    arm.run(motions[k], 1.0, 1.0);
    EXPECT_NE(arm.watch.words(), "");
    arm.watch.restart();
    EXPECT_EQ(arm.watch.words(), "");
    arm.run(motions[k], 1.0, 1.0);
    EXPECT_EQ(arm.watch.words(), "");
  }
}

// It was told the same for so long that no delay explains it.
TEST(OpposedMotion, AnAxisThatTurnsRoundInAFastMotionIsNoticedSoon) {
  const scope::Velocity motions[] = {
      {0.1, 0.0, 0.0, 0.0}, {0.0, 0.1, 0.0, 0.0}, {0.0, 0.0, 0.1, 0.0}, {0.0, 0.0, 0.0, 0.01}};
  for (const scope::Velocity& motion : motions) {
    Arm arm;
    arm.run(motion, 1.0, 1.0);
    arm.run(motion, 0.04, -1.0);
    EXPECT_EQ(arm.watch.words(), "") << "two reports may be wrong";
    arm.run(motion, 0.04, -1.0);
    EXPECT_NE(arm.watch.words(), "");
    Arm slow;
    const auto slowly = scope::Velocity::fromVector(0.3 * motion.vector());
    slow.run(slowly, 1.0, 1.0);
    slow.run(slowly, 0.1, -1.0);
    EXPECT_EQ(slow.watch.words(), "");
  }
}

// Held again and again, as by a dead-man switch that bounces: no motion lasts, and they add up.
TEST(OpposedMotion, MotionsThatAreInterruptedAddUp) {
  Arm arm;
  int held = 0;
  for (; arm.watch.words().empty() && held < 20; ++held) {
    arm.run({0.1, 0.0, 0.0, 0.0}, 0.1, -1.0);
    arm.run(scope::Velocity(), 0.3, -1.0);
  }
  EXPECT_LE(held, 3);
  // Where it moves as it is told in between, they do not.
  Arm mended;
  for (int k = 0; k < 20; ++k) {
    mended.run({0.1, 0.0, 0.0, 0.0}, 0.1, -1.0);
    mended.run(scope::Velocity(), 0.3, -1.0);
    mended.run({0.1, 0.0, 0.0, 0.0}, 0.3, 1.0);
    mended.run(scope::Velocity(), 0.3, 1.0);
  }
  EXPECT_EQ(mended.watch.words(), "");
}

TEST(OpposedMotion, AnArmThatIsHeldAndIsABitLateIsNotOpposed) {
  for (const double delay : {0.1, 0.24}) {
    Arm arm;
    for (int k = 0; k < 40; ++k) {
      arm.run({k % 2 == 0 ? 0.1 : -0.1, 0.0, 0.0, 0.0}, 0.1, 1.0, delay);
      arm.run(scope::Velocity(), 0.06, 1.0, delay);
    }
    EXPECT_EQ(arm.watch.words(), "") << delay;
  }
}

TEST(OpposedMotion, RestAndNoiseWithinTheDeadZoneAreNotOpposed) {
  Arm arm;
  arm.run({0.1, 0.1, 0.1, 0.01}, 2.0, 0.0);
  arm.run({0.1, 0.1, 0.1, 0.01}, 2.0, -0.05);
  EXPECT_EQ(arm.watch.words(), "");
}

TEST(OpposedMotion, NumbersThatAreNoneChangeNothing) {
  OpposedMotion watch{scope::Velocity{0.004, 0.004, 0.004, 0.0004}};
  CommandHistory told{5.0, 0.2};
  told.add(0.0, {0.1, 0.0, 0.0, 0.0});
  watch.report(std::nan(""), {-0.1, 0.0, 0.0, 0.0}, told, kDelay);
  watch.report(0.1, {std::nan(""), 0.0, 0.0, 0.0}, told, kDelay);
  EXPECT_EQ(watch.words(), "");
}

}  // namespace
}  // namespace laparoscope_servo::servo
