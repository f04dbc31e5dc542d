#include "laparoscope_servo/servo/horizon.h"

#include <gtest/gtest.h>

#include <cmath>

#include "laparoscope_servo/geometry/se3.h"

namespace laparoscope_servo::servo {
namespace {

TEST(HorizonAngle, IsZeroForAnUprightPicture) {
  EXPECT_NEAR(horizonAngle({0.0, -1.0, 0.0}).value(), 0.0, 1e-15);
  EXPECT_NEAR(horizonAngle({0.0, -0.3, 0.9}).value(), 0.0, 1e-15);  // looking up or down does not turn the picture
  EXPECT_NEAR(std::abs(horizonAngle({0.0, 2.0, 0.0}).value()), M_PI, 1e-12);
}

// A camera that spins clockwise by an angle sees what is up turn the other way, as alpha of the features does.
TEST(HorizonAngle, FallsWithTheCamerasSpin) {
  for (const double spin : {-1.0, 0.1, 2.0}) {
    const Eigen::Vector3d up = geometry::so3Exp({0.0, 0.0, spin}).transpose() * Eigen::Vector3d(0.0, -1.0, 0.2);
    EXPECT_NEAR(horizonAngle(up).value(), -spin, 1e-12);
  }
}

TEST(HorizonAngle, IsNothingWhereTheCameraLooksAlongIt) {
  EXPECT_FALSE(horizonAngle({0.0, 0.0, 1.0}).has_value());
  EXPECT_FALSE(horizonAngle({0.05, 0.0, -1.0}).has_value());
  EXPECT_FALSE(horizonAngle({std::nan(""), 0.0, 1.0}).has_value());
  EXPECT_FALSE(horizonAngle(Eigen::Vector3d::Zero()).has_value());
}

}  // namespace
}  // namespace laparoscope_servo::servo
