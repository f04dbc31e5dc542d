#include "laparoscope_servo/servo/dead_zone.h"

#include <gtest/gtest.h>

#include <cmath>

namespace laparoscope_servo::servo {
namespace {

DeadZoneConfig config() {
  DeadZoneConfig c;
  c.width = {0.004, 0.003, 0.002, 0.0004};
  c.stop = {0.001, 0.001, 0.001, 0.0001};
  c.start = {0.002, 0.002, 0.002, 0.0002};
  return c;
}

ScopeVelocity all(double angular, double linear) {
  return {angular, angular, angular, linear};
}

// The robot as the classic dead zone: nothing below the width, less by the width above.
double robot(double command, double width) {
  return std::abs(command) <= width ? 0.0 : command - std::copysign(width, command);
}

TEST(DeadZoneInverse, IsZeroAtRest) {
  DeadZoneInverse inverse(config());
  EXPECT_EQ(inverse.apply(ScopeVelocity()).vector(), Eigen::Vector4d::Zero());
  EXPECT_EQ(inverse.apply(all(0.0019, 0.00019)).vector(), Eigen::Vector4d::Zero());
  EXPECT_EQ(inverse.apply(all(-0.0019, -0.00019)).vector(), Eigen::Vector4d::Zero());
}

TEST(DeadZoneInverse, UndoesTheDeadZoneOfTheRobot) {
  DeadZoneInverse inverse(config());
  const Eigen::Vector4d width = config().width.vector();
  for (const double sign : {1.0, -1.0}) {
    const ScopeVelocity wanted = all(sign * 0.01, sign * 0.001);
    const Eigen::Vector4d command = inverse.apply(wanted).vector();
    for (int k = 0; k < 4; ++k) EXPECT_NEAR(robot(command[k], width[k]), wanted.vector()[k], 1e-15);
  }
}

TEST(DeadZoneInverse, StartsAtOneThresholdAndStopsAtALowerOne) {
  DeadZoneInverse inverse(config());
  EXPECT_EQ(inverse.apply({0.0015, 0, 0, 0}).pan, 0.0);
  EXPECT_GT(inverse.apply({0.0020, 0, 0, 0}).pan, 0.0);
  EXPECT_GT(inverse.apply({0.0015, 0, 0, 0}).pan, 0.0);
  EXPECT_GT(inverse.apply({0.0010, 0, 0, 0}).pan, 0.0);
  EXPECT_EQ(inverse.apply({0.0009, 0, 0, 0}).pan, 0.0);
  EXPECT_EQ(inverse.apply({0.0015, 0, 0, 0}).pan, 0.0);
}

TEST(DeadZoneInverse, AxesAreIndependent) {
  DeadZoneInverse inverse(config());
  for (int axis = 0; axis < 4; ++axis) {
    inverse.reset();
    Eigen::Vector4d wanted = Eigen::Vector4d::Zero();
    wanted[axis] = 0.01;
    const Eigen::Vector4d command = inverse.apply(ScopeVelocity::fromVector(wanted)).vector();
    for (int k = 0; k < 4; ++k) EXPECT_EQ(command[k] != 0.0, k == axis);
  }
}

TEST(DeadZoneInverse, ResetPutsAllAxesToRest) {
  DeadZoneInverse inverse(config());
  inverse.apply(all(0.01, 0.01));
  inverse.reset();
  EXPECT_EQ(inverse.apply(all(0.0015, 0.00015)).vector(), Eigen::Vector4d::Zero());
}

TEST(DeadZoneInverse, IsOddAndMonotoneAtRestAndInMotion) {
  for (const bool moving : {false, true}) {
    double last = -1.0;
    for (int k = -1000; k <= 1000; ++k) {
      const double wanted = 1e-5 * k;
      DeadZoneInverse inverse(config());
      DeadZoneInverse mirrored(config());
      if (moving) {
        inverse.apply(all(0.05, 0.05));
        mirrored.apply(all(0.05, 0.05));
      }
      const double command = inverse.apply({wanted, 0, 0, 0}).pan;
      EXPECT_GE(command, last) << "wanted " << wanted;
      EXPECT_GE(command * wanted, 0.0);
      EXPECT_EQ(mirrored.apply({-wanted, 0, 0, 0}).pan, -command);
      last = command;
    }
  }
}

TEST(DeadZoneInverse, PassesOnWhatItGetsWhenSwitchedOff) {
  DeadZoneConfig off = config();
  off.inverse = false;
  DeadZoneInverse inverse(off);
  for (const double wanted : {0.0, 1e-9, -0.003, 0.5}) {
    EXPECT_EQ(inverse.apply(all(wanted, wanted)).vector(), all(wanted, wanted).vector());
  }
}

TEST(DeadZoneInverse, ZeroThresholdsKeepZeroAtZero) {
  DeadZoneConfig sharp = config();
  sharp.stop = sharp.start = ScopeVelocity();
  DeadZoneInverse inverse(sharp);
  EXPECT_EQ(inverse.apply(ScopeVelocity()).vector(), Eigen::Vector4d::Zero());
  inverse.apply(all(0.1, 0.1));
  EXPECT_EQ(inverse.apply(ScopeVelocity()).vector(), Eigen::Vector4d::Zero());
}

}  // namespace
}  // namespace laparoscope_servo::servo
