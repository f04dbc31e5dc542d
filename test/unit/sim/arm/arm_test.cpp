#include "laparoscope_servo/sim/arm.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

namespace laparoscope_servo::sim {
namespace {

using aesop::JointVector;

const aesop::Kinematics kKinematics{aesop::KinematicsConfig()};

Arm arm(const ArmConfig& config = ArmConfig()) {
  Arm result(kKinematics, config);
  result.step(0.0);
  return result;
}

double distanceFromTrocar(const Arm& arm) {
  const Eigen::Vector3d p = kKinematics.endEffector(arm.position()).inverse() * ArmConfig().insertion_point;
  return p.head<2>().norm();
}

TEST(Arm, startsWithTheShaftInTheTrocar) {
  const Arm a = arm();
  EXPECT_LT(distanceFromTrocar(a), 1e-9);
  EXPECT_NEAR(kKinematics.leverArm(a.position(), ArmConfig().insertion_point), 0.2, 1e-4) << "d2 is 0.1 m";
  EXPECT_LT(kKinematics.endEffector(a.position()).linear()(2, 2), -0.999) << "the scope hangs down";
  EXPECT_FALSE(a.isMoving());
}

TEST(Arm, nothingHappensBeforeTheDelay) {
  Arm a = arm();
  const JointVector before = a.position();
  a.command({0.01, 0.0, 0.0, 0.0}, 1.0);
  EXPECT_TRUE(a.isMoving()) << "a motion is under way";
  a.step(1.159);
  EXPECT_EQ(a.position(), before);
  a.step(1.2);
  EXPECT_GT(a.position()[0], before[0]);
}

TEST(Arm, aGainMultipliesTheSpeedAndALagAddsToTheDelay) {
  Arm a = arm();
  a.setGain(-2.0);
  a.setLag(0.3);
  a.command({0.01, 0.0, 0.0, 0.0}, 0.0);
  a.step(0.455);
  EXPECT_EQ(a.position()[0], 0.25);
  a.step(1.0);
  EXPECT_NEAR(a.velocity()[0], -0.02, 1e-6);
  a.setGain(1.0);
  a.step(1.5);
  EXPECT_NEAR(a.velocity()[0], 0.01, 1e-6);
}

TEST(Arm, aReversedJointGoesTheOtherWayAndTheOthersDoNot) {
  Arm a = arm();
  a.reverse(1);
  a.command({0.01, 0.02, 0.0, 0.0}, 0.0);
  a.step(1.0);
  EXPECT_NEAR(a.velocity()[0], 0.01, 1e-6);
  EXPECT_NEAR(a.velocity()[1], -0.02, 1e-6);
  a.reverse(-1);
  a.step(1.5);
  EXPECT_NEAR(a.velocity()[1], 0.02, 1e-6);
}

TEST(Arm, aLagThatEndsKeepsTheOrderOfCommands) {
  Arm a = arm();
  a.setLag(0.3);
  a.command({0.01, 0.0, 0.0, 0.0}, 0.0);
  a.setLag(0.0);
  a.command({}, 0.1);
  a.step(2.0);
  EXPECT_TRUE(a.velocity().isZero(0.0));
  EXPECT_EQ(a.position()[0], 0.25) << "stopped in the moment in which it would have begun";
}

TEST(Arm, jointsReachTheirSpeedAndStopLate) {
  Arm a = arm();
  a.command({0.01, 0.0, 0.0, 0.1}, 0.0);
  a.step(1.0);
  EXPECT_NEAR(a.velocity()[0], 0.01, 1e-6);
  EXPECT_NEAR(a.velocity()[6], 0.1, 1e-6);
  a.command({}, 1.0);
  a.step(1.155);
  EXPECT_NEAR(a.velocity()[0], 0.01, 1e-6);
  a.step(1.5);
  EXPECT_TRUE(a.velocity().isZero(0.0));
  EXPECT_FALSE(a.isMoving());
  EXPECT_NEAR(a.position()[0], 0.25 + 0.01 * 1.0, 2e-4);
}

TEST(Arm, wristFollowsTheTrocar) {
  Arm a = arm();
  a.command({0.005, 0.03, -0.04, 0.2}, 0.0);
  for (int k = 0; k < 20; ++k) {
    a.step(0.1 * k);
    EXPECT_LT(distanceFromTrocar(a), 1e-9);
    EXPECT_EQ(a.position()[3], 0.0) << "joint 4 is set by hand";
  }
  EXPECT_NE(a.velocity()[4], 0.0);
  EXPECT_NE(a.velocity()[5], 0.0);
}

TEST(Arm, deadZoneAndBreakaway) {
  ArmConfig config;
  config.delay = 0.0;
  const double dead = config.dead_zone[6];
  Arm a = arm(config);
  a.command({0.0, 0.0, 0.0, 1.1 * dead}, 0.0);
  a.step(1.0);
  EXPECT_EQ(a.velocity()[6], 0.0) << "at rest it takes more than the dead zone";
  a.command({0.0, 0.0, 0.0, 2.0 * dead}, 1.0);
  a.step(2.0);
  EXPECT_NEAR(a.velocity()[6], 2.0 * dead, 1e-9);
  a.command({0.0, 0.0, 0.0, 1.1 * dead}, 2.0);
  a.step(3.0);
  EXPECT_NEAR(a.velocity()[6], 1.1 * dead, 1e-9) << "once it moves, the dead zone alone counts";
  a.command({0.0, 0.0, 0.0, 0.9 * dead}, 3.0);
  a.step(4.0);
  EXPECT_EQ(a.velocity()[6], 0.0);
}

TEST(Arm, stepsOfAnyLengthGiveTheSameMotion) {
  Arm fine = arm();
  Arm coarse = arm();
  for (Arm* a : {&fine, &coarse}) {
    a->command({0.005, 0.03, 0.0, 0.0}, 0.0);
    a->command({}, 0.5);
  }
  for (int k = 1; k <= 1000; ++k) fine.step(0.5 + 0.001 * k);
  coarse.step(1.5);
  EXPECT_LT((fine.position() - coarse.position()).norm(), 1e-4);
}

TEST(Arm, jointLimitsHold) {
  Arm a = arm();
  a.command({0.05, 0.0, 0.0, 0.0}, 0.0);
  for (int k = 0; k < 100; ++k) a.step(0.1 * k);
  EXPECT_LE(a.position()[0], 0.381);
}

TEST(Arm, aWristAtItsLimitSticks) {
  aesop::KinematicsConfig stiff;
  stiff.joints[5].minimum = -0.05;
  stiff.joints[5].maximum = 0.05;
  Arm a{aesop::Kinematics(stiff), ArmConfig()};
  a.step(0.0);
  a.command({0.0, 0.1, 0.0, 0.0}, 0.0);
  for (int k = 0; k < 100 && a.stuck().empty(); ++k) a.step(0.05 * k);
  EXPECT_NE(a.stuck().find("joint 6"), std::string::npos) << a.stuck();
  EXPECT_TRUE(a.velocity().isZero(0.0));
}

TEST(Arm, brakeStandsAtOnceAndForgets) {
  Arm a = arm();
  a.command({0.01, 0.0, 0.0, 0.0}, 0.0);
  a.step(1.0);
  a.command({0.02, 0.0, 0.0, 0.0}, 1.0);
  a.brake();
  const JointVector before = a.position();
  EXPECT_FALSE(a.isMoving());
  a.step(3.0);
  EXPECT_EQ(a.position(), before);
}

TEST(Arm, handMovesTheScopeAboutTheTrocar) {
  Arm a = arm();
  const Eigen::Isometry3d before = kKinematics.optical(a.position());
  ASSERT_EQ(a.hand({0.17, 0.0, 0.0, 0.02}, 1.0, 0.0), "");
  EXPECT_TRUE(a.isInHand());
  EXPECT_NE(a.hand({0.1, 0.0, 0.0, 0.0}, 1.0, 0.5), "") << "one hand at a time";
  a.step(2.0);
  EXPECT_FALSE(a.isMoving());
  EXPECT_LT(distanceFromTrocar(a), 1e-9);
  const Eigen::Isometry3d motion = before.inverse() * kKinematics.optical(a.position());
  EXPECT_NEAR(std::asin(motion.linear()(0, 2)), 0.17, 2e-3);
  EXPECT_NEAR(kKinematics.leverArm(a.position(), ArmConfig().insertion_point), 0.18, 3e-4);
}

TEST(Arm, handRefusesNonsense) {
  Arm a = arm();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(a.hand({nan, 0.0, 0.0, 0.0}, 1.0, 0.0), "");
  EXPECT_NE(a.hand({0.1, 0.0, 0.0, 0.0}, nan, 0.0), "");
  EXPECT_NE(a.hand({0.1, 0.0, 0.0, 0.0}, -1.0, 0.0), "");
  EXPECT_FALSE(a.isMoving());
}

TEST(Arm, refusesWhatCannotBe) {
  EXPECT_TRUE(validate(ArmConfig()).empty());
  ArmConfig config;
  config.delay = -1.0;
  config.breakaway = 0.5;
  config.start[2] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(validate(config).size(), 3u);
  EXPECT_THROW(arm(config), std::invalid_argument);
  config = ArmConfig();
  config.start[0] = 1.0;  // above the column
  EXPECT_THROW(arm(config), std::invalid_argument);
  config = ArmConfig();
  config.insertion_point.z() += 0.5;  // above the wrist: it cannot point there
  EXPECT_THROW(arm(config), std::invalid_argument);
}

// As a speed, each would put the joint at its limit within one step.
TEST(Arm, refusesNumbersThatAreNotFiniteAndStaysWhereItIs) {
  for (const double wrong : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    Arm a = arm();
    const JointVector before = a.position();
    EXPECT_THROW(a.command({0.0, wrong, 0.0, 0.0}, 0.0), std::invalid_argument);
    EXPECT_THROW(a.setGain(wrong), std::invalid_argument);
    EXPECT_THROW(a.setLag(wrong), std::invalid_argument);
    EXPECT_FALSE(a.isMoving());
    a.step(1.0);
    EXPECT_EQ(a.position(), before);
    a.command({0.01, 0.0, 0.0, 0.0}, 1.0);
    a.step(2.0);
    EXPECT_GT(a.position()[0], before[0]);
  }
}

}  // namespace
}  // namespace laparoscope_servo::sim
