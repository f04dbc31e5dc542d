#include "laparoscope_servo/scope/geometry.h"

#include <gtest/gtest.h>

#include <random>

#include "laparoscope_servo/scope/insertion_point.h"

namespace laparoscope_servo::servo {
namespace {

scope::Velocity any(std::mt19937& random) {
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  return {u(random), u(random), u(random), 0.1 * u(random)};
}

TEST(InsertionPointMotions, AreEquation10ForStraightOptics) {
  std::mt19937 random(1);
  for (int k = 0; k < 50; ++k) {
    const scope::Velocity velocity = any(random);
    const scope::Geometry scope{Eigen::Matrix3d::Identity(), 0.03 + 0.001 * k};
    EXPECT_NEAR(
        (scope::insertionPointMotions(scope) * velocity.vector() - scope::cameraTwist(velocity, scope.d2)).norm(), 0.0,
        1e-15);
  }
}

// With any optics: at the insertion point the rigid body moves along the shaft only.
TEST(InsertionPointMotions, DoNotMoveTheInsertionPointSideways) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  for (int k = 0; k < 100; ++k) {
    const scope::Geometry scope{scope::obliqueOptics(u(random), 3.0 * u(random)), 0.1 + 0.05 * u(random)};
    const scope::Velocity velocity = any(random);
    Eigen::Isometry3d camera_T_shaft = Eigen::Isometry3d::Identity();  // at the insertion point
    camera_T_shaft.linear() = scope.camera_R_shaft;
    camera_T_shaft.translation() = scope.camera_R_shaft * Eigen::Vector3d(0.0, 0.0, -scope.d2);
    const geometry::Vector6d there =
        geometry::twistTransform(camera_T_shaft.inverse()) * (scope::insertionPointMotions(scope) * velocity.vector());
    geometry::Vector6d expected;
    expected << 0.0, 0.0, velocity.insertion, velocity.tilt, velocity.pan, velocity.spin;
    EXPECT_NEAR((there - expected).norm(), 0.0, 1e-14);
  }
}

TEST(ObliqueOptics, LookAsFarToTheSideAsTheySay) {
  EXPECT_TRUE(scope::obliqueOptics(0.0).isIdentity(1e-15));
  for (const double angle : {0.3, 0.5236, 0.7854}) {
    for (const double roll : {0.0, 1.0, -2.0}) {
      const Eigen::Matrix3d camera_R_shaft = scope::obliqueOptics(angle, roll);
      EXPECT_TRUE((camera_R_shaft * camera_R_shaft.transpose()).isIdentity(1e-12));
      EXPECT_NEAR(std::acos(camera_R_shaft(2, 2)), angle, 1e-12);  // between the shaft's axis and the camera's
    }
  }
  // Without roll the camera looks down: its optical axis leans towards the shaft's +y.
  EXPECT_NEAR(scope::obliqueOptics(0.5).transpose().col(2).y(), std::sin(0.5), 1e-12);
}

}  // namespace
}  // namespace laparoscope_servo::servo
