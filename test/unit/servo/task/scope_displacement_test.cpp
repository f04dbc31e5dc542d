#include "servo/task/scope_displacement.h"

#include <gtest/gtest.h>

#include <random>

#include "unit/servo/plane_loop.h"

namespace laparoscope_servo::servo {
namespace {

using test::kD2;
using test::kZ;
using test::PlaneLoop;
using test::straight;

class ScopeDisplacement : public ::testing::TestWithParam<double> {
 protected:
  Eigen::Vector4d any(double size) {
    std::uniform_real_distribution<double> u(-1.0, 1.0);
    return size * Eigen::Vector4d(u(random_), u(random_), u(random_), 0.1 * u(random_));
  }
  std::mt19937 random_{4};
  scope::Geometry scope_{scope::obliqueOptics(GetParam(), 0.3), kD2};
};

// Against the true scope before a plane across the axis, whose centre stays the ROI's centre.
TEST_P(ScopeDisplacement, MovesTheFeaturesAsTheScopeDoes) {
  for (int k = 0; k < 50; ++k) {
    const Eigen::Vector4d displacement = any(0.15);
    PlaneLoop loop(Eigen::Vector3d::UnitZ(), kZ, scope_);
    const TaskError predicted = moved(loop.error(), displacement, scope_, kZ);
    const Eigen::Vector3d rotation = scope::angularVelocity(scope::Velocity::fromVector(displacement));
    // The rotation first, in one, and then the insertion.
    loop.offset({rotation.y(), rotation.x(), rotation.z(), 0.0});
    loop.offset({0.0, 0.0, 0.0, displacement[3]});
    const TaskError real = loop.error();
    EXPECT_NEAR(predicted.x, real.x, 0.02);  // the ROI is 1/4 wide: its area's centre is not its corners' cross
    EXPECT_NEAR(predicted.y, real.y, 0.02);
    EXPECT_NEAR(predicted.log_depth, real.log_depth, 0.06);
    EXPECT_NEAR(predicted.alpha, real.alpha, 0.02);
    EXPECT_NEAR((predicted.e_v - real.e_v).norm(), 0.0, 0.02);
    EXPECT_NEAR(predicted.e_w.z(), real.e_w.z(), 0.05);
  }
}

TEST_P(ScopeDisplacement, NoDisplacementChangesNothing) {
  PlaneLoop loop(Eigen::Vector3d::UnitZ(), kZ, scope_);
  loop.offset({0.1, 0.05, 0.2, 0.01});
  const TaskError error = loop.error();
  const TaskError same = moved(error, Eigen::Vector4d::Zero(), loop.scope(), kZ);
  EXPECT_NEAR(same.x, error.x, 1e-12);
  EXPECT_NEAR(same.y, error.y, 1e-12);
  EXPECT_NEAR(same.log_depth, error.log_depth, 1e-12);
  EXPECT_NEAR(same.alpha, error.alpha, 1e-12);
  EXPECT_NEAR((same.e_w - error.e_w).norm(), 0.0, 1e-12);
}

TEST_P(ScopeDisplacement, LeadsToTheTarget) {
  int found = 0;
  for (int k = 0; k < 100; ++k) {
    TaskError error;
    const Eigen::Vector4d off = any(0.3);
    error.x = off[0];
    error.y = off[1];
    error.log_depth = 3.0 * off[3];
    error.alpha = 3.0 * off[2];
    const Eigen::Vector4d displacement = displacementToTarget(error, scope_, kZ);
    ASSERT_TRUE(displacement.allFinite());
    const TaskError there = moved(error, displacement, scope_, kZ);
    EXPECT_NEAR(there.x, 0.0, 1e-9);
    EXPECT_NEAR(there.y, 0.0, 1e-9);
    EXPECT_NEAR(there.log_depth, 0.0, 1e-9);
    EXPECT_NEAR(there.alpha, 0.0, 1e-9);
    ++found;
  }
  EXPECT_EQ(found, 100);
}

INSTANTIATE_TEST_SUITE_P(Optics, ScopeDisplacement, ::testing::Values(0.0, 0.5236, 0.7854));

TEST(ScopeDisplacementErrors, SayThemselves) {
  TaskError error;
  // Pushed through the tissue.
  EXPECT_FALSE(std::isfinite(moved(error, {0.0, 0.0, 0.0, 0.1}, straight(), kZ).x));
  error.x = std::nan("");
  EXPECT_FALSE(displacementToTarget(error, straight(), kZ).allFinite());
}

}  // namespace
}  // namespace laparoscope_servo::servo
