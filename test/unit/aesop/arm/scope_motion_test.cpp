#include "laparoscope_servo/aesop/scope_motion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "laparoscope_servo/geometry/se3.h"
#include "laparoscope_servo/scope/insertion_point.h"
#include "unit/aesop/nominal_pose.h"

namespace laparoscope_servo::aesop {
namespace {

const Kinematics kKinematics{KinematicsConfig()};
const MotionConfig kConfig;
constexpr double kPi = 3.14159265358979323846;

JointMotion motionAt(const JointVector& q, const scope::Velocity& velocity) {
  return jointMotion(kKinematics, kConfig, q, nominalTrocar(), velocity);
}

// Drives the arm as the trocar would have it: driven joints integrate, the wrist follows.
JointVector drive(JointVector q, const scope::Velocity& velocity, double seconds, JointMotion* last = nullptr) {
  const double dt = 0.02;
  for (double t = 0.0; t < seconds - 0.5 * dt; t += dt) {
    const JointMotion motion = motionAt(q, velocity);
    if (last != nullptr) *last = motion;
    for (const int k : kKinematics.driven()) q[k] += dt * motion.velocity[k];
    const WristSolution wrist = kKinematics.solveWrist(q, nominalTrocar());
    EXPECT_TRUE(wrist.ok) << wrist.reason;
    q = wrist.q;
  }
  return q;
}

TEST(ScopeMotion, trocarStandsStill) {  // eq. (12) gives (9) and (10): no lateral velocity at O_A
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (int trial = 0; trial < 100; ++trial) {
    const scope::Velocity velocity{uniform(random), uniform(random), uniform(random), uniform(random)};
    const double d1 = 0.2 + 0.1 * uniform(random);
    const geometry::Vector6d twist = scope::endEffectorTwist(velocity, d1);
    const Eigen::Vector3d w = twist.tail<3>();
    const Eigen::Vector3d at_trocar = twist.head<3>() + w.cross(Eigen::Vector3d(0.0, 0.0, d1));
    EXPECT_LT((at_trocar - Eigen::Vector3d(0.0, 0.0, velocity.insertion)).norm(), 1e-14);
  }
}

TEST(ScopeMotion, jointVelocitiesGiveTheScopeVelocity) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (int trial = 0; trial < 100; ++trial) {
    JointVector q = nominalPose();
    for (int k = 0; k < kJoints; ++k) q[k] += 0.03 * uniform(random);
    q = kKinematics.solveWrist(q, nominalTrocar()).q;
    const scope::Velocity wanted{0.02 * uniform(random), 0.02 * uniform(random), 0.02 * uniform(random),
                                 0.005 * uniform(random)};
    const JointMotion motion = motionAt(q, wanted);
    ASSERT_EQ(motion.scale, 1.0) << motion.reason;
    EXPECT_EQ(motion.velocity[3], 0.0) << "joint 4 is set by hand";
    const scope::Velocity got = scopeVelocity(kKinematics, q, motion.velocity);
    EXPECT_NEAR(got.pan, wanted.pan, 1e-12);
    EXPECT_NEAR(got.tilt, wanted.tilt, 1e-12);
    EXPECT_NEAR(got.spin, wanted.spin, 1e-12);
    EXPECT_NEAR(got.insertion, wanted.insertion, 1e-12);
  }
}

// The solved velocities of the passive joints are what the trocar does to them, by differences.
TEST(ScopeMotion, wristFollowsAsPredicted) {
  const JointVector q = nominalPose();
  const JointMotion motion = motionAt(q, {0.05, -0.03, 0.02, 0.004});
  const double dt = 1e-5;
  JointVector next = q;
  for (const int k : kKinematics.driven()) next[k] += dt * motion.velocity[k];
  next = kKinematics.solveWrist(next, nominalTrocar()).q;
  EXPECT_LT(((next - q) / dt - motion.velocity).norm(), 1e-5);
}

// Signs as the camera sees them: pan turns the axis right, tilt up (towards -y), spin clockwise, insertion ahead.
TEST(ScopeMotion, conventions) {
  const JointVector q = nominalPose();
  const Eigen::Isometry3d before = kKinematics.optical(q);
  const auto after = [&](const scope::Velocity& velocity) {
    return Eigen::Isometry3d(before.inverse() * kKinematics.optical(drive(q, velocity, 1.0)));
  };
  EXPECT_GT(after({0.05, 0.0, 0.0, 0.0}).linear()(0, 2), 0.04);
  EXPECT_LT(after({0.0, 0.05, 0.0, 0.0}).linear()(1, 2), -0.04);
  EXPECT_GT(after({0.0, 0.0, 0.05, 0.0}).linear()(1, 0), 0.04);
  EXPECT_NEAR(after({0.0, 0.0, 0.0, 0.01}).translation().z(), 0.01, 1e-6);
}

TEST(ScopeMotion, workspaceOfTheStartPose) {  // ±20° of pan and tilt, ±40 mm of insertion
  const double angle = 20.0 * kPi / 180.0;
  for (const double insertion : {-0.04, 0.0, 0.04}) {
    const JointVector start = insertion == 0.0 ? nominalPose() : drive(nominalPose(), {0, 0, 0, insertion / 8.0}, 8.0);
    for (int direction = 0; direction < 8; ++direction) {
      const double c = std::cos(direction * kPi / 4.0);
      const double s = std::sin(direction * kPi / 4.0);
      JointMotion last;
      const JointVector q = drive(start, {angle / 8.0 * c, angle / 8.0 * s, 0.0, 0.0}, 8.0, &last);
      EXPECT_EQ(last.scale, 1.0) << last.reason;
      EXPECT_EQ(kKinematics.error(q), "");
      EXPECT_GT(conditioning(kKinematics, q), 0.4);
      const double turned = std::acos(-kKinematics.endEffector(q).linear()(2, 2));
      EXPECT_NEAR(turned, angle, 0.005);
      EXPECT_NEAR(kKinematics.leverArm(q, nominalTrocar()), 0.2 - insertion, 5e-4);
    }
  }
}

TEST(ScopeMotion, slowedThenHeldAtTheDepthAndFreeToReturn) {
  JointMotion last;
  const JointVector deep = drive(nominalPose(), {0.0, 0.0, 0.0, 0.02}, 20.0, &last);
  EXPECT_LT(last.scale, 1e-3);
  EXPECT_NE(last.reason.find("depth"), std::string::npos) << last.reason;
  EXPECT_LE(0.30 - kKinematics.leverArm(deep, nominalTrocar()), KinematicsConfig().depth_maximum + 1e-9);
  EXPECT_EQ(motionAt(deep, {0.0, 0.0, 0.0, -0.02}).scale, 1.0);
}

TEST(ScopeMotion, jointLimitHoldsAndLetsBack) {
  KinematicsConfig config;
  config.joints[0].maximum = 0.25;  // where it stands
  const Kinematics limited(config);
  const JointMotion up = jointMotion(limited, kConfig, nominalPose(), nominalTrocar(), {0.0, 0.0, 0.0, -0.01});
  EXPECT_EQ(up.scale, 0.0);
  EXPECT_EQ(up.velocity, JointVector::Zero());
  EXPECT_NE(up.reason.find("joint 1"), std::string::npos) << up.reason;
  EXPECT_EQ(jointMotion(limited, kConfig, nominalPose(), nominalTrocar(), {0.0, 0.0, 0.0, 0.01}).scale, 1.0);
}

TEST(ScopeMotion, beyondALimitMotionBackIsAllowed) {
  KinematicsConfig config;
  config.joints[0].maximum = 0.24;
  const Kinematics limited(config);
  EXPECT_EQ(jointMotion(limited, kConfig, nominalPose(), nominalTrocar(), {0.0, 0.0, 0.0, -0.01}).scale, 0.0);
  EXPECT_GT(jointMotion(limited, kConfig, nominalPose(), nominalTrocar(), {0.0, 0.0, 0.0, 0.01}).scale, 0.0);
}

TEST(ScopeMotion, jointSpeedKeepsTheDirection) {
  const JointMotion slow = motionAt(nominalPose(), {0.01, 0.02, 0.0, 0.0});
  const JointMotion fast = motionAt(nominalPose(), {1.0, 2.0, 0.0, 0.0});
  EXPECT_LT(fast.scale, 1.0);
  EXPECT_NE(fast.reason.find("highest speed"), std::string::npos);
  EXPECT_NEAR(slow.velocity.normalized().dot(fast.velocity.normalized()), 1.0, 1e-12);
  for (int k = 0; k < kJoints; ++k) {
    EXPECT_LE(std::abs(fast.velocity[k]), KinematicsConfig().joints[static_cast<std::size_t>(k)].max_speed + 1e-12);
  }
}

TEST(ScopeMotion, stretchedArmIsSlowedAndHeld) {
  // Straightening the elbow (joint 3 to zero) with the scope hanging down makes the arm singular.
  double previous = 1.0;
  for (const double elbow : {0.9, 0.6, 0.4, 0.2, 0.05}) {
    JointVector q = nominalPose();
    q[2] = elbow;
    const double value = conditioning(kKinematics, q);
    EXPECT_LT(value, previous);
    previous = value;
    const Eigen::Vector3d trocar = kKinematics.endEffector(q) * Eigen::Vector3d(0.0, 0.0, 0.2);
    bool held = false;
    for (int direction = 0; direction < 8; ++direction) {
      const scope::Velocity velocity{0.02 * std::cos(direction * kPi / 4), 0.02 * std::sin(direction * kPi / 4), 0.0,
                                     0.0};
      const JointMotion motion = jointMotion(kKinematics, kConfig, q, trocar, velocity);
      EXPECT_TRUE(motion.velocity.allFinite());
      held = held || (motion.scale == 0.0 && motion.reason.find("singular") != std::string::npos);
    }
    if (value > kConfig.singular_slow) {
      EXPECT_FALSE(held);
    }
    if (value < kConfig.singular_stop) {
      EXPECT_TRUE(held);
    }
  }
  EXPECT_LT(previous, kConfig.singular_stop);
}

TEST(ScopeMotion, notFiniteIsRefused) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double inf = std::numeric_limits<double>::infinity();
  for (const scope::Velocity& velocity : {scope::Velocity{nan, 0, 0, 0}, scope::Velocity{0, inf, 0, 0},
                                          scope::Velocity{0, 0, -inf, 0}, scope::Velocity{0, 0, 0, nan}}) {
    const JointMotion motion = motionAt(nominalPose(), velocity);
    EXPECT_EQ(motion.scale, 0.0);
    EXPECT_EQ(motion.velocity, JointVector::Zero());
    EXPECT_FALSE(motion.reason.empty());
  }
  JointVector q = nominalPose();
  q[4] = nan;
  EXPECT_EQ(motionAt(q, {0.01, 0, 0, 0}).velocity, JointVector::Zero());
  EXPECT_EQ(jointMotion(kKinematics, kConfig, nominalPose(), {nan, 0, 0}, {0.01, 0, 0, 0}).scale, 0.0);
}

// A velocity that overflows in the joints moves none, and makes no number that is none.
TEST(ScopeMotion, overflowIsRefused) {
  for (const double huge : {1e300, 1e308, -1e308}) {
    for (int axis = 0; axis < 4; ++axis) {
      Eigen::Vector4d velocity = Eigen::Vector4d::Zero();
      velocity[axis] = huge;
      const JointMotion motion = motionAt(nominalPose(), scope::Velocity::fromVector(velocity));
      EXPECT_TRUE(motion.velocity.allFinite()) << axis << ' ' << huge;
      for (int k = 0; k < kJoints; ++k) {
        const double limit = kKinematics.config().joints[static_cast<std::size_t>(k)].max_speed;
        EXPECT_LE(std::abs(motion.velocity[k]), limit * (1.0 + 1e-9)) << axis << ' ' << huge;
      }
    }
  }
}

TEST(ScopeMotion, shaftOffTheTrocarIsRefused) {
  const Eigen::Vector3d elsewhere = nominalTrocar() + Eigen::Vector3d(0.03, 0.0, 0.0);
  const JointMotion motion = jointMotion(kKinematics, kConfig, nominalPose(), elsewhere, {0.01, 0, 0, 0});
  EXPECT_EQ(motion.scale, 0.0);
  EXPECT_NE(motion.reason.find("insertion point"), std::string::npos);
}

TEST(ScopeMotion, zeroIsZero) {
  const JointMotion motion = motionAt(nominalPose(), {});
  EXPECT_EQ(motion.velocity, JointVector::Zero());
  EXPECT_EQ(motion.reason, "");
}

}  // namespace
}  // namespace laparoscope_servo::aesop
