#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "laparoscope_servo/geometry/se3.h"
#include "servo/shaping/workspace.h"

namespace laparoscope_servo::servo {
namespace {

// The shaft along the cone's axis, turned by tilt and pan.
Eigen::Matrix3d shaft(double tilt, double pan) {
  return geometry::so3Exp({M_PI, 0.0, 0.0}) * geometry::so3Exp({tilt, pan, 0.0});
}

double angleOf(const Workspace& range, const Eigen::Matrix3d& r) {
  return std::acos(std::min(1.0, r.col(2).dot(Eigen::Vector3d(range.axis[0], range.axis[1], range.axis[2]))));
}

TEST(Workspace, LeavesWhatIsFarFromItsBounds) {
  const scope::Velocity velocity{0.1, -0.05, 0.3, 0.01};
  EXPECT_EQ(within(Workspace(), velocity, 0.1, shaft(0.0, 0.0)).vector(), velocity.vector());
  EXPECT_EQ(within(Workspace(), velocity, 0.1, shaft(0.4, -0.3)).vector(), velocity.vector());
}

TEST(Workspace, SlowsTowardsTheDepthsAndStopsThereButLetsBack) {
  const Workspace range;
  const scope::Velocity deeper{0, 0, 0, 0.01}, out{0, 0, 0, -0.01};
  EXPECT_NEAR(within(range, deeper, range.max_depth - 0.5 * range.depth_margin).insertion, 0.005, 1e-12);
  EXPECT_EQ(within(range, deeper, range.max_depth).insertion, 0.0);
  EXPECT_EQ(within(range, deeper, range.max_depth + 0.01).insertion, 0.0);
  EXPECT_EQ(within(range, out, range.max_depth + 0.01).insertion, -0.01);
  EXPECT_EQ(within(range, out, range.min_depth).insertion, 0.0);
  EXPECT_EQ(within(range, deeper, range.min_depth).insertion, 0.01);
  EXPECT_EQ(within(range, deeper, std::nan("")).insertion, 0.0);
}

// Whatever is wanted, for long: the shaft does not leave the cone.
TEST(Workspace, KeepsTheShaftInTheCone) {
  Workspace range;
  range.cone = 0.5;
  std::mt19937 random(2);
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  for (int n = 0; n < 20; ++n) {
    const scope::Velocity wanted{0.5 * u(random), 0.5 * u(random), 0.3 * u(random), 0.0};
    Eigen::Matrix3d r = shaft(0.0, 0.0);
    for (int k = 0; k < 2000; ++k) {
      const scope::Velocity v = within(range, wanted, 0.1, r);
      r = r * geometry::so3Exp(0.01 * Eigen::Vector3d(v.tilt, v.pan, v.spin));
      ASSERT_LE(angleOf(range, r), range.cone + 0.01) << n;
    }
  }
}

TEST(Workspace, DoesNotTurnWhereItLooksOutOfTheBodyOrNobodyKnowsWhere) {
  const scope::Velocity velocity{0.1, 0.1, 0.1, 0.0};
  const Eigen::Matrix3d out = Eigen::Matrix3d::Identity();  // against the axis
  EXPECT_EQ(within(Workspace(), velocity, 0.1, out).vector(), Eigen::Vector4d(0.0, 0.0, 0.1, 0.0));
  const Eigen::Matrix3d unknown = Eigen::Matrix3d::Constant(std::nan(""));
  EXPECT_EQ(within(Workspace(), velocity, 0.1, unknown).pan, 0.0);
}

TEST(Workspace, LetsBackFromOutsideTheConeAndAlongIt) {
  Workspace range;
  range.cone = 0.5;
  const Eigen::Matrix3d outside = shaft(0.0, 0.7);  // panned too far
  EXPECT_EQ(within(range, {-0.1, 0.0, 0.0, 0.0}, 0.1, outside).pan, -0.1);
  EXPECT_NEAR(within(range, {0.1, 0.0, 0.0, 0.0}, 0.1, outside).pan, 0.0, 1e-12);
  EXPECT_NEAR(within(range, {0.1, 0.07, 0.0, 0.0}, 0.1, outside).tilt, 0.07, 1e-12);
  EXPECT_EQ(within(range, {0.1, 0.0, 0.2, 0.0}, 0.1, outside).spin, 0.2);
}

}  // namespace
}  // namespace laparoscope_servo::servo
