#include "laparoscope_servo/sim/scope_body.h"

#include <gtest/gtest.h>

#include <random>

namespace laparoscope_servo::sim {
namespace {

using geometry::Vector6d;

const double kLength = 0.35;
const double kDepth = 0.1;

ScopeBody body() {
  return {Eigen::Isometry3d::Identity(), {0.0, 0.0, -kDepth}, kLength};
}

Vector6d twist(double vx, double vy, double vz, double wx, double wy, double wz) {
  Vector6d t;
  t << vx, vy, vz, wx, wy, wz;
  return t;
}

TEST(ScopeBody, KnowsWhereTheInsertionPointIs) {
  const ScopeBody scope({Eigen::Isometry3d(Eigen::Translation3d(0.03, 0.04, 0.02))}, {0.0, 0.0, -kDepth}, kLength);
  EXPECT_NEAR(scope.depth(), 0.12, 1e-15);
  EXPECT_NEAR(scope.lateralOffset(), 0.05, 1e-15);
}

TEST(ScopeBody, PushingInChangesOnlyTheDepth) {
  ScopeBody scope = body();
  scope.move(twist(0, 0, 0.02, 0, 0, 0), 0.5);
  EXPECT_NEAR(scope.depth(), 0.11, 1e-15);
  EXPECT_NEAR(scope.lateralOffset(), 0.0, 1e-15);
}

// The end-effector swings the other way when the scope pans: the insertion point stays.
TEST(ScopeBody, PanWithTheRightLeverStaysInTheInsertionPoint) {
  ScopeBody scope = body();
  const double pan = 0.1;
  const double d1 = kLength - kDepth;
  for (int k = 0; k < 100; ++k) scope.move(twist(-d1 * pan, 0, 0, 0, pan, 0), 0.01);
  EXPECT_NEAR(scope.lateralOffset(), 0.0, 1e-14);
  EXPECT_NEAR(scope.depth(), kDepth, 1e-14);
  EXPECT_GT(scope.pose().translation().x(), 0.0);
  const Vector6d camera = scope.tipTwist(twist(-d1 * pan, 0, 0, 0, pan, 0));
  EXPECT_NEAR(camera[0], kDepth * pan, 1e-15);
}

TEST(ScopeBody, AWrongLeverLeavesTheInsertionPoint) {
  ScopeBody scope = body();
  scope.move(twist(-0.5 * (kLength - kDepth) * 0.1, 0, 0, 0, 0.1, 0), 1.0);
  EXPECT_GT(scope.lateralOffset(), 0.005);
}

// A passive wrist: whatever the end-effector does, and wherever the insertion point goes, the shaft passes through it.
TEST(ScopeBody, APassiveWristFollowsTheInsertionPoint) {
  ScopeBody scope(Eigen::Isometry3d::Identity(), {0.0, 0.0, -kDepth}, kLength, Wrist::kPassive);
  std::mt19937 random(6);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (int k = 0; k < 200; ++k) {
    scope.moveInsertionPoint({0.01 * uniform(random), 0.01 * uniform(random), -kDepth + 0.01 * uniform(random)});
    EXPECT_LT(scope.lateralOffset(), 1e-12);
    scope.move(twist(0.05 * uniform(random), 0.05 * uniform(random), 0.02 * uniform(random), uniform(random),
                     uniform(random), uniform(random)),
               0.02);
    EXPECT_LT(scope.lateralOffset(), 1e-12);
    EXPECT_TRUE((scope.pose().linear() * scope.pose().linear().transpose()).isIdentity(1e-12));
  }
}

TEST(ScopeBody, APassiveWristPansAndSpinsAsAStiffOneDoes) {
  ScopeBody stiff = body();
  ScopeBody passive(Eigen::Isometry3d::Identity(), {0.0, 0.0, -kDepth}, kLength, Wrist::kPassive);
  const double d1 = kLength - kDepth;
  for (int k = 0; k < 1000; ++k) {
    const Vector6d t = twist(-d1 * 0.1, 0.0, 0.0, 0.0, 0.1, 0.2);
    stiff.move(t, 1e-3);
    passive.move(t, 1e-3);
  }
  EXPECT_TRUE(passive.pose().isApprox(stiff.pose(), 1e-3));
}

// The twist is expressed in the moving frame: many small steps do what one long one does.
TEST(ScopeBody, StepsAddUp) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (int n = 0; n < 20; ++n) {
    Vector6d t;
    for (int k = 0; k < 6; ++k) t[k] = (k < 3 ? 0.05 : 1.0) * uniform(random);
    ScopeBody once = body();
    ScopeBody often = body();
    once.move(t, 1.0);
    for (int k = 0; k < 100; ++k) often.move(t, 0.01);
    EXPECT_TRUE(once.pose().isApprox(often.pose(), 1e-10));
  }
}

}  // namespace
}  // namespace laparoscope_servo::sim
