// The sides of cylinders and the points of circles, by what they have to be.
#include "model/strands.h"

#include <gtest/gtest.h>

#include "support/synthetic_model.h"

namespace laparoscope_servo::model {
namespace {

const Eigen::Isometry3d kPose = test::viewOf(*test::modelOf(test::kCubeAndTube), 0.6);

TEST(Strands, theSidesOfACylinderAreWhereRaysTouchIt) {
  const auto model = test::modelOf(test::kCubeAndTube);
  const Cylinder& tube = model->cylinders[0];
  const Eigen::Vector3d begin = kPose * tube.begin, axis = (kPose * tube.end - begin).normalized();
  Eigen::Vector3d at[2];
  for (int side = 0; side < 2; ++side) {
    const Segment line = sideSegment(tube, kPose, side);
    ASSERT_TRUE(line.exists);
    EXPECT_TRUE((line.end - line.begin).normalized().isApprox(axis));
    for (const double along : {0.0, 0.4, 1.0}) {
      const Eigen::Vector3d point = line.at(along), arm = point - begin;
      const Eigen::Vector3d normal = arm - arm.dot(axis) * axis;
      EXPECT_NEAR(normal.norm(), tube.radius, 1e-12);
      EXPECT_NEAR(normal.normalized().dot(point.normalized()), 0.0, 1e-12);  // across the ray
    }
    at[side] = line.at(0.5);
  }
  EXPECT_GT((at[0] - at[1]).norm(), 1.5 * tube.radius);
}

TEST(Strands, fromWithinACylinderThereAreNoSides) {
  const Cylinder tube{{0.0, 0.0, -1.0}, {0.0, 0.0, 1.0}, 0.1};
  EXPECT_FALSE(sideSegment(tube, Eigen::Isometry3d::Identity(), 0).exists);
  const Cylinder beside{{0.05, 0.0, -1.0}, {0.05, 0.0, 1.0}, 0.1};
  EXPECT_FALSE(sideSegment(beside, Eigen::Isometry3d::Identity(), 1).exists);
}

TEST(Strands, theDerivativesOfACircleHoldByDifferences) {
  const auto model = test::modelOf(test::kCubeAndTube);
  const Circle& circle = model->circles[0];
  constexpr double kStep = 1e-5;
  for (double angle = 0.1; angle < 6.3; angle += 0.7) {
    const CirclePoint here = circlePoint(circle, kPose, angle);
    const CirclePoint more = circlePoint(circle, kPose, angle + kStep),
                      less = circlePoint(circle, kPose, angle - kStep);
    EXPECT_NEAR((here.point - kPose * circle.centre).norm(), circle.radius, 1e-12);
    EXPECT_TRUE(here.first.isApprox((more.point - less.point) / (2.0 * kStep), 1e-7));
    EXPECT_TRUE(here.second.isApprox((more.first - less.first) / (2.0 * kStep), 1e-7));
  }
}

TEST(Strands, theOpeningOfACircleIsOneFromAboveAndZeroFromItsPlane) {
  Circle circle;
  circle.radius = 0.1;
  circle.centre = {0.0, 0.0, 1.0};
  EXPECT_NEAR(circleOpening(circle, Eigen::Isometry3d::Identity()), 1.0, 1e-12);
  circle.v = Eigen::Vector3d::UnitZ();
  EXPECT_NEAR(circleOpening(circle, Eigen::Isometry3d::Identity()), 0.0, 1e-12);
}

}  // namespace
}  // namespace laparoscope_servo::model
