#include "servo/safety/manual_stick.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>
#include <vector>

namespace laparoscope_servo::servo {
namespace {

const scope::Velocity kFull{0.1, 0.1, 0.1, 0.02};
const scope::Velocity kRight{0.05, 0.0, 0.0, 0.0};

// Steps of 20 ms.
class Stick {
 public:
  std::string step(const scope::Velocity& velocity, bool drives = true, double age = 0.01) {
    time_ += 0.02;
    return stick.update({velocity, age}, drives, time_);
  }
  // A hand that is never quite still.
  std::string hold(double seconds) {
    std::string last;
    for (int k = 0; k < std::lround(seconds / 0.02); ++k) last = step({0.05 + 1e-6 * (k % 7), 0.0, 0.0, 0.0});
    return last;
  }

  ManualStick stick{SafetyConfig(), kFull};

 private:
  double time_ = 0.0;
};

TEST(ManualStick, HasToBeSeenAtRestFirst) {
  Stick stick;
  EXPECT_NE(stick.step(kRight).find("release the stick once"), std::string::npos);
  EXPECT_NE(stick.hold(10.0), "") << "insisting does not help";
  EXPECT_EQ(stick.step({}), "");
  EXPECT_EQ(stick.step(kRight), "");
  EXPECT_EQ(stick.hold(10.0), "");
}

TEST(ManualStick, RestIsNearZeroInEachComponent) {
  for (int axis = 0; axis < 4; ++axis) {
    Eigen::Vector4d velocity = Eigen::Vector4d::Zero();
    for (const double sign : {-1.0, 1.0}) {
      Stick inside, outside;
      velocity[axis] = sign * 0.019 * kFull.vector()[axis];
      EXPECT_EQ(inside.step(scope::Velocity::fromVector(velocity)), "");
      velocity[axis] = sign * 0.021 * kFull.vector()[axis];
      EXPECT_NE(outside.step(scope::Velocity::fromVector(velocity)), "");
    }
  }
}

TEST(ManualStick, WhatCountsAsReleasedMovesNothing) {
  const ManualStick stick(SafetyConfig(), kFull);
  const scope::Velocity trembling{0.0019, -0.0019, 0.0021, -0.0003};
  EXPECT_EQ(stick.deflection(trembling).vector(), Eigen::Vector4d(0.0, 0.0, 0.0021, 0.0));
  EXPECT_EQ(stick.deflection(kRight).vector(), kRight.vector());
}

TEST(ManualStick, AStickThatRestsBesideZeroIsNoPadOutOfReach) {
  Stick stick;
  for (int k = 0; k < 1000; ++k) ASSERT_EQ(stick.step({0.0012, 0.0, 0.0, 0.0}), "") << k;
  EXPECT_EQ(stick.step(kRight), "");
}

TEST(ManualStick, WhateverInterruptsTheDriveAsksForRestAgain) {
  const double nan = std::nan("");
  const std::vector<std::function<void(Stick&)>> interruptions{
      [](Stick& s) { s.step(kRight, false); },       // HOLD, another task
      [](Stick& s) { s.stick.restart(); },           // engaged anew within a step
      [](Stick& s) { s.step(kRight, true, 0.21); },  // silence
      [nan](Stick& s) {
        s.step({nan, 0.0, 0.0, 0.0});
      },                                               // not finite
      [nan](Stick& s) { s.step(kRight, true, nan); },  // no age
      [](Stick& s) { s.step(kRight, true, -0.01); }};  // from the future
  for (std::size_t k = 0; k < interruptions.size(); ++k) {
    Stick stick;
    stick.step({});
    EXPECT_EQ(stick.step(kRight), "") << k;
    interruptions[k](stick);
    EXPECT_NE(stick.step({0.04, 0.0, 0.0, 0.0}), "") << k;
    EXPECT_EQ(stick.step({}), "") << k;
    EXPECT_EQ(stick.step(kRight), "") << k;
  }
}

TEST(ManualStick, RestThatWasSeenWhileItDidNotDriveDoesNotCount) {
  Stick stick;
  stick.step({}, false);
  EXPECT_NE(stick.step(kRight), "");
}

TEST(ManualStick, APadThatRepeatsIsOutOfReach) {
  Stick stick;
  stick.step({});
  double moved = 0.0;
  std::string problem;
  for (int k = 0; k < 1000; ++k) {
    problem = stick.step(kRight);
    if (problem.empty()) moved += 0.02;
  }
  EXPECT_NEAR(moved, SafetyConfig().max_manual_repeat, 0.05);
  EXPECT_NE(problem.find("same to the last digit"), std::string::npos) << problem;
  // Something changes: it is there again, and has to be seen at rest.
  EXPECT_NE(stick.step({0.04, 0.0, 0.0, 0.0}).find("release"), std::string::npos);
  EXPECT_EQ(stick.step({}), "");
  EXPECT_EQ(stick.step(kRight), "");
}

TEST(ManualStick, APadAtRestMayRepeat) {
  Stick stick;
  for (int k = 0; k < 1000; ++k) EXPECT_EQ(stick.step({}), "");
  EXPECT_EQ(stick.step(kRight), "");
}

}  // namespace
}  // namespace laparoscope_servo::servo
