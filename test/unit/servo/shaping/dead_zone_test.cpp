#include "servo/shaping/dead_zone.h"

#include <gtest/gtest.h>

#include <cmath>

namespace laparoscope_servo::servo {
namespace {

const scope::Velocity kWidth{0.004, 0.003, 0.002, 0.0004};

scope::Velocity all(double angular, double linear) {
  return {angular, angular, angular, linear};
}

TEST(DeadZone, NothingWantedIsNothingCommanded) {
  EXPECT_EQ(throughDeadZone(scope::Velocity(), kWidth).vector(), Eigen::Vector4d::Zero());
  EXPECT_EQ(afterDeadZone(scope::Velocity(), kWidth).vector(), Eigen::Vector4d::Zero());
}

TEST(DeadZone, TheInverseUndoesIt) {
  for (const double sign : {1.0, -1.0}) {
    const scope::Velocity wanted = all(sign * 0.01, sign * 0.001);
    EXPECT_NEAR((afterDeadZone(throughDeadZone(wanted, kWidth), kWidth).vector() - wanted.vector()).norm(), 0.0, 1e-15);
  }
}

TEST(DeadZone, WhatIsBelowItIsNotExecuted) {
  EXPECT_EQ(afterDeadZone(kWidth, kWidth).vector(), Eigen::Vector4d::Zero());
  EXPECT_EQ(afterDeadZone(scope::Velocity::fromVector(-0.9 * kWidth.vector()), kWidth).vector(),
            Eigen::Vector4d::Zero());
}

TEST(DeadZone, TheInverseIsOddMonotoneAndContinuous) {
  double last = throughDeadZone({-0.01, 0, 0, 0}, kWidth).pan;
  for (int k = -999; k <= 1000; ++k) {
    const double wanted = 1e-5 * k;
    const double command = throughDeadZone({wanted, 0, 0, 0}, kWidth).pan;
    EXPECT_GT(command, last);
    EXPECT_LT(command - last, 12e-5);  // eleven times as steep as its argument, no jump
    EXPECT_EQ(throughDeadZone({-wanted, 0, 0, 0}, kWidth).pan, -command);
    last = command;
  }
}

TEST(DeadZone, AxesAreIndependent) {
  for (int axis = 0; axis < 4; ++axis) {
    Eigen::Vector4d wanted = Eigen::Vector4d::Zero();
    wanted[axis] = 0.01;
    const Eigen::Vector4d command = throughDeadZone(scope::Velocity::fromVector(wanted), kWidth).vector();
    for (int k = 0; k < 4; ++k) EXPECT_EQ(command[k] != 0.0, k == axis);
    EXPECT_NEAR(command[axis], 0.01 + kWidth.vector()[axis], 1e-15);
  }
}

TEST(DeadZone, WithoutWidthBothDoNothing) {
  for (const double wanted : {0.0, 1e-9, -0.003, 0.5}) {
    EXPECT_EQ(throughDeadZone(all(wanted, wanted), scope::Velocity()).vector(), all(wanted, wanted).vector());
    EXPECT_EQ(afterDeadZone(all(wanted, wanted), scope::Velocity()).vector(), all(wanted, wanted).vector());
  }
}

TEST(DeadZone, WhatIsNoNumberStaysNone) {
  const double nan = std::nan("");
  EXPECT_TRUE(throughDeadZone(all(nan, nan), kWidth).vector().array().isNaN().all());
  EXPECT_TRUE(afterDeadZone(all(nan, nan), kWidth).vector().array().isNaN().all());
}

}  // namespace
}  // namespace laparoscope_servo::servo
