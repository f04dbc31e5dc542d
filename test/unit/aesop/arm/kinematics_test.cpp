#include "laparoscope_servo/aesop/kinematics.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>
#include <stdexcept>

#include "laparoscope_servo/geometry/se3.h"
#include "unit/aesop/nominal_pose.h"

namespace laparoscope_servo::aesop {
namespace {

const Kinematics kKinematics{KinematicsConfig()};

JointVector randomJoints(std::mt19937& random) {
  JointVector q;
  for (int k = 0; k < kJoints; ++k) {
    const DhJoint& joint = kKinematics.config().joints[static_cast<std::size_t>(k)];
    q[k] = std::uniform_real_distribution<double>(joint.minimum, joint.maximum)(random);
  }
  return q;
}

// Check values of the public table, origin of frame 7 in metres to four digits.
TEST(Kinematics, checkValues) {
  const Eigen::Isometry3d straight = kKinematics.endEffector(JointVector::Zero());
  EXPECT_TRUE(straight.translation().isApprox(Eigen::Vector3d(0.7915, 0.0, -0.1), 1e-9));
  EXPECT_TRUE(straight.linear().col(2).isApprox(Eigen::Vector3d(0.0, 0.0, -1.0), 1e-9));
  const Eigen::Vector3d raised = kKinematics.endEffector(joints(0.2, 0, 0, 0.3, 0, 0, 0)).translation();
  EXPECT_LT((raised - Eigen::Vector3d(0.8071, 0.0, 0.1965)).lpNorm<Eigen::Infinity>(), 6e-5);
  const Eigen::Vector3d bent = kKinematics.endEffector(joints(0.2, 0.5, -0.7, 0, 0.3, -0.4, 0.1)).translation();
  EXPECT_LT((bent - Eigen::Vector3d(0.7021, 0.1437, 0.1059)).lpNorm<Eigen::Infinity>(), 6e-5);
}

TEST(Kinematics, linkFramesChainFromTheBase) {
  std::mt19937 random(1);
  const auto frames = kKinematics.linkFrames(randomJoints(random));
  EXPECT_TRUE(frames[0].isApprox(Eigen::Isometry3d::Identity()));
  for (std::size_t k = 1; k < frames.size(); ++k) {
    EXPECT_NEAR(frames[k].linear().determinant(), 1.0, 1e-12);
    const DhJoint& joint = kKinematics.config().joints[k - 1];
    const Eigen::Isometry3d link = frames[k - 1].inverse() * frames[k];
    EXPECT_NEAR(link.translation().head<2>().norm(), std::abs(joint.a), 1e-12) << "link " << k;
  }
}

TEST(Kinematics, opticalFrameIsAheadOnTheShaft) {
  const Eigen::Isometry3d end_T_optical =
      kKinematics.endEffector(nominalPose()).inverse() * kKinematics.optical(nominalPose());
  EXPECT_TRUE(end_T_optical.linear().isIdentity(1e-12));
  EXPECT_TRUE(end_T_optical.translation().isApprox(Eigen::Vector3d(0.0, 0.0, 0.30), 1e-12));
}

// The table of some other arm: any lengths, any angles, joints that turn or slide.
KinematicsConfig randomTable(std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  KinematicsConfig config;
  for (DhJoint& joint : config.joints) {
    joint.alpha = 3.0 * uniform(random);
    joint.a = 0.5 * uniform(random);
    joint.d = 0.5 * uniform(random);
    joint.theta = 3.0 * uniform(random);
    joint.prismatic = joint.role != JointRole::kPassive && uniform(random) > 0.3;
  }
  return config;
}

TEST(Kinematics, jacobianIsTheDerivative) {
  std::mt19937 random(2);
  const double step = 1e-6;
  for (int trial = 0; trial < 100; ++trial) {
    const Kinematics kinematics = trial % 2 == 0 ? kKinematics : Kinematics(randomTable(random));
    const JointVector q = randomJoints(random);
    const Jacobian j = kinematics.jacobian(q);
    for (int k = 0; k < kJoints; ++k) {
      const JointVector dq = step * JointVector::Unit(k);
      const Eigen::Isometry3d plus = kinematics.endEffector(q + dq);
      const Eigen::Isometry3d minus = kinematics.endEffector(q - dq);
      const Eigen::Vector3d v = (plus.translation() - minus.translation()) / (2.0 * step);
      const Eigen::Vector3d w = geometry::so3Log(plus.linear() * minus.linear().transpose()) / (2.0 * step);
      EXPECT_LT((j.col(k).head<3>() - v).norm(), 1e-7 * (1.0 + j.col(k).norm())) << "joint " << k + 1;
      EXPECT_LT((j.col(k).tail<3>() - w).norm(), 1e-7) << "joint " << k + 1;
    }
  }
}

TEST(Kinematics, wristPointsTheShaftAtTheTrocar) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> offset(-0.3, 0.3);
  for (int trial = 0; trial < 100; ++trial) {
    JointVector q = nominalPose();
    q[0] += 0.1 * offset(random);
    q[1] += 0.5 * offset(random);
    q[2] += 0.5 * offset(random);
    q[3] = 0.3 * offset(random);
    q[6] = 10.0 * offset(random);
    const WristSolution solution = kKinematics.solveWrist(q, nominalTrocar());
    ASSERT_TRUE(solution.ok) << solution.reason;
    const Eigen::Vector3d p = kKinematics.endEffector(solution.q).inverse() * nominalTrocar();
    EXPECT_LT(p.head<2>().norm(), 1e-11);
    EXPECT_GT(p.z(), 0.0);
    for (const int k : {0, 1, 2, 3, 6}) EXPECT_EQ(solution.q[k], q[k]) << "joint " << k + 1 << " is not the wrist's";
    EXPECT_NEAR(kKinematics.leverArm(solution.q, nominalTrocar()), p.z(), 1e-12);
  }
}

TEST(Kinematics, wristDoesNotReachEverywhere) {
  const Eigen::Isometry3d end = kKinematics.endEffector(nominalPose());
  const WristSolution behind = kKinematics.solveWrist(nominalPose(), end * Eigen::Vector3d(0.0, 0.0, -0.2));
  EXPECT_FALSE(behind.ok);
  EXPECT_FALSE(behind.reason.empty());
  EXPECT_FALSE(kKinematics.solveWrist(nominalPose(), end * Eigen::Vector3d(0.0, 0.0, 0.005)).ok);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(kKinematics.solveWrist(nominalPose(), Eigen::Vector3d(0.0, nan, 0.0)).ok);
  EXPECT_FALSE(kKinematics.solveWrist(JointVector::Constant(nan), nominalTrocar()).ok);
}

TEST(Kinematics, wristKeepsItsLimits) {
  KinematicsConfig config;
  config.joints[5].maximum = 0.1;
  config.joints[5].minimum = -0.1;
  const Kinematics stiff(config);
  const Eigen::Vector3d aside = nominalTrocar() + Eigen::Vector3d(0.08, 0.05, 0.0);
  ASSERT_TRUE(kKinematics.solveWrist(nominalPose(), aside).ok);
  const WristSolution solution = stiff.solveWrist(nominalPose(), aside);
  EXPECT_FALSE(solution.ok);
  EXPECT_NE(solution.reason.find("joint 6"), std::string::npos) << solution.reason;
}

TEST(Kinematics, errorNamesTheJoint) {
  EXPECT_EQ(kKinematics.error(nominalPose()), "");
  JointVector q = nominalPose();
  q[0] = 0.5;
  EXPECT_NE(kKinematics.error(q).find("joint 1 at 0.5 m"), std::string::npos);
  q[0] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(kKinematics.error(q).find("joint 1"), std::string::npos);
}

TEST(Kinematics, refusesAWrongConfiguration) {
  KinematicsConfig config;
  config.scope_length = 0.0;
  EXPECT_THROW(Kinematics{config}, std::invalid_argument);
}

}  // namespace
}  // namespace laparoscope_servo::aesop
