#include "servo/task/horizon.h"

#include <gtest/gtest.h>

#include <cmath>

#include "laparoscope_servo/geometry/se3.h"

namespace laparoscope_servo::servo {
namespace {

TEST(HorizonError, IsZeroForAnUprightPicture) {
  EXPECT_NEAR(horizonError({0.0, -1.0, 0.0}), 0.0, 1e-15);
  EXPECT_NEAR(horizonError({0.0, -0.3, 0.9}), 0.0, 1e-15);  // looking up or down does not turn the picture
  EXPECT_NEAR(std::abs(horizonError({0.0, 2.0, 0.0})), M_PI, 1e-12);
}

// A camera that spins clockwise by an angle sees what is up turn the other way, as alpha of the features does.
TEST(HorizonError, FallsWithTheCamerasSpin) {
  for (const double spin : {-1.0, 0.1, 2.0}) {
    const Eigen::Vector3d up = geometry::so3Exp({0.0, 0.0, spin}).transpose() * Eigen::Vector3d(0.0, -1.0, 0.2);
    EXPECT_NEAR(horizonError(up), -spin, 1e-12);
  }
}

TEST(HorizonError, FadesWhereTheCameraLooksAlongIt) {
  EXPECT_EQ(horizonError({0.0, 0.0, 1.0}), 0.0);
  EXPECT_EQ(horizonError({0.05, 0.0, -1.0}), 0.0);
  EXPECT_EQ(horizonError({std::nan(""), 0.0, 1.0}), 0.0);
  EXPECT_EQ(horizonError(Eigen::Vector3d::Zero()), 0.0);
  double last = 0.0;
  for (int k = 0; k <= 300; ++k) {  // from along it to 17 degrees away, to the right of it
    const double away = 0.001 * k;
    const double error = horizonError({std::sin(away), 0.0, std::cos(away)});
    EXPECT_GE(error, last);
    EXPECT_LT(error - last, 0.02);  // no step
    last = error;
  }
  EXPECT_NEAR(last, 0.5 * M_PI, 1e-12);
}

}  // namespace
}  // namespace laparoscope_servo::servo
