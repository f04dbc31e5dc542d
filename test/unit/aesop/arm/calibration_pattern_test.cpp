#include "laparoscope_servo/aesop/calibration_pattern.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "laparoscope_servo/sim/arm.h"

namespace laparoscope_servo::aesop {
namespace {

using Eigen::Vector3d;

constexpr double kPeriod = 0.025;  // s
const Vector3d kBelieved = sim::ArmConfig().insertion_point;

struct Outcome {
  CalibrationPattern::Step end;
  double seconds = 0.0;
  double largest_angle = 0.0;  // rad, of the shaft from where it started
  double angle_at_end = 0.0;
  double depth_change = 0.0;  // m, the largest, at the believed insertion point
  int quadrants = 0;
};

// The pattern through the emulated arm, with its delay, dead zones and friction.
Outcome run(
    const sim::ArmConfig& arm_config, const PatternConfig& config = PatternConfig(),
    const KinematicsConfig& geometry = KinematicsConfig(),
    const std::function<void(double, JointVector&)>& disturb = [](double, JointVector&) {}) {
  const Kinematics kinematics(geometry);
  sim::Arm arm(kinematics, arm_config);
  arm.step(0.0);
  const Eigen::Matrix3d start = kinematics.endEffector(arm.position()).linear();
  const double start_lever = kinematics.leverArm(arm.position(), kBelieved);
  CalibrationPattern pattern(config, kinematics, arm.position(), kBelieved, 0.0);
  JointMotion motion;
  Outcome result;
  unsigned quadrants = 0;
  for (double now = 0.0; now < 120.0; now += kPeriod) {
    JointVector q = arm.position();
    disturb(now, q);
    const CalibrationPattern::Step step = pattern.step(q, motion, now);
    const bool over = step.done || !step.problem.empty();
    EXPECT_TRUE(!over || step.velocity.isZero());
    EXPECT_EQ(step.velocity.spin, 0.0);
    EXPECT_LE(std::abs(step.velocity.insertion), 0.005);
    EXPECT_LE(std::hypot(step.velocity.pan, step.velocity.tilt), config.speed + 1e-12);
    motion = jointMotion(kinematics, MotionConfig(), q, kBelieved, step.velocity);
    std::array<double, kDrivenJoints> speed{};
    for (std::size_t k = 0; k < speed.size(); ++k) speed[k] = motion.velocity[kinematics.driven()[k]];
    arm.command(speed, now);
    arm.step(now + kPeriod);
    const Vector3d axis = start.transpose() * kinematics.endEffector(arm.position()).linear().col(2);
    result.angle_at_end = std::acos(std::min(1.0, axis.z()));
    result.largest_angle = std::max(result.largest_angle, result.angle_at_end);
    const double lever = kinematics.leverArm(arm.position(), kBelieved);
    result.depth_change = std::max(result.depth_change, std::abs(lever - start_lever));
    if (result.angle_at_end > 0.8 * config.angle)
      quadrants |= 1u << ((axis.x() > 0.0 ? 1 : 0) + (axis.y() > 0.0 ? 2 : 0));
    result.quadrants = __builtin_popcount(quadrants);
    if (!over) continue;
    const CalibrationPattern::Step again = pattern.step(q, motion, now + kPeriod);
    EXPECT_EQ(again.done, step.done) << "the end stays the end";
    EXPECT_EQ(again.problem, step.problem);
    EXPECT_TRUE(again.velocity.isZero());
    result.end = step;
    result.seconds = now;
    return result;
  }
  ADD_FAILURE() << "the pattern does not end";
  return result;
}

TEST(CalibrationPattern, GoesRoundTheConeAndBack) {
  const Outcome done = run(sim::ArmConfig());
  EXPECT_TRUE(done.end.done) << done.end.problem;
  EXPECT_EQ(done.quadrants, 4);
  EXPECT_LT(done.largest_angle, PatternConfig().angle + 0.02);
  EXPECT_LT(done.angle_at_end, 0.02);
  EXPECT_GT(done.seconds, 10.0);
  EXPECT_LT(done.seconds, 40.0);
}

TEST(CalibrationPattern, AWrongInsertionPointDoesNotLeadItAstray) {
  for (const Vector3d& wrong : {Vector3d(0.01, 0.0, 0.0), Vector3d(0.0, -0.01, 0.0), Vector3d(0.0, 0.0, 0.01),
                                Vector3d(-0.006, 0.006, -0.006)}) {
    for (const double speed : {0.02, 0.05, 0.15}) {
      sim::ArmConfig arm;
      arm.insertion_point += wrong;
      PatternConfig config;
      config.speed = speed;
      const Outcome done = run(arm, config);
      EXPECT_TRUE(done.end.done) << wrong.transpose() << ": " << done.end.problem;
      EXPECT_EQ(done.quadrants, 4);
      EXPECT_LT(done.largest_angle, config.angle + 0.05);
      EXPECT_LT(done.angle_at_end, 0.04);
      EXPECT_LT(done.depth_change, 0.004);
    }
  }
}

TEST(CalibrationPattern, EndsWhereTheArmIsHeld) {
  KinematicsConfig tight;
  tight.joints[4].maximum = tight.joints[5].maximum = 0.05;
  tight.joints[4].minimum = tight.joints[5].minimum = -0.05;
  const Outcome held = run(sim::ArmConfig(), PatternConfig(), tight);
  EXPECT_FALSE(held.end.done);
  EXPECT_NE(held.end.problem.find("limit"), std::string::npos) << held.end.problem;
  sim::ArmConfig far;
  far.insertion_point += Vector3d(0.03, 0.0, 0.0);
  EXPECT_NE(run(far).end.problem.find("the shaft passes the insertion point"), std::string::npos);
}

TEST(CalibrationPattern, EndsWhenTheArmDoesNotFollow) {
  sim::ArmConfig stiff;
  stiff.dead_zone << 0.2, 0.2, 0.2, 0.0, 0.0, 0.0, 0.2;
  const Outcome stuck = run(stiff);
  EXPECT_EQ(stuck.end.problem, "the shaft does not follow");
  EXPECT_NEAR(stuck.seconds, PatternConfig().patience, 0.2);
}

TEST(CalibrationPattern, EndsWhenTheShaftLeavesTheConeOrTheDepth) {
  const auto pushed = [](double now, JointVector& q) {
    if (now > 5.0) q[5] += 0.3;
  };
  const Outcome aside = run(sim::ArmConfig(), PatternConfig(), KinematicsConfig(), pushed);
  EXPECT_FALSE(aside.end.done);
  EXPECT_NE(aside.end.problem.find("the shaft has turned by"), std::string::npos) << aside.end.problem;
  const auto pulled = [](double now, JointVector& q) {
    if (now > 5.0) q[0] += 0.02;
  };
  const Outcome out = run(sim::ArmConfig(), PatternConfig(), KinematicsConfig(), pulled);
  EXPECT_NE(out.end.problem.find("the depth has changed by -0.0"), std::string::npos) << out.end.problem;
}

TEST(CalibrationPattern, PositionsThatAreNotFiniteEndIt) {
  const auto nan = [](double now, JointVector& q) {
    if (now > 1.0) q[1] = std::numeric_limits<double>::quiet_NaN();
  };
  EXPECT_FALSE(run(sim::ArmConfig(), PatternConfig(), KinematicsConfig(), nan).end.problem.empty());
}

TEST(CalibrationPattern, ConfigurationNamesEveryError) {
  EXPECT_TRUE(validate(PatternConfig()).empty());
  PatternConfig config;
  config.angle = config.speed = config.max_depth_change = config.patience = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(validate(config).size(), 4u);
}

}  // namespace
}  // namespace laparoscope_servo::aesop
