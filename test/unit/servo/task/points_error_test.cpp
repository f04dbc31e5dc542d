// The robust law on points as the task's error: the displacement that it tells is the scope's, whatever is astray.
#include "laparoscope_servo/servo/points_error.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "servo/law/feature_law.h"
#include "servo/task/scope_displacement.h"

namespace laparoscope_servo::servo {
namespace {

constexpr double kDepth = 0.08;  // m, Z*
const Eigen::Vector2d kMiddle(0.0, 0.0);

scope::Geometry scopeOf(double angle) {
  return {scope::obliqueOptics(angle, 0.3), 0.11};
}

// 25 points of the desired view, seen after the scope was displaced from there.
std::vector<PointTask> seenAfter(const Eigen::Vector4d& displacement, const scope::Geometry& now) {
  scope::Geometry desired_scope = now;
  desired_scope.d2 -= displacement[3];
  std::vector<PointTask> points;
  for (int k = 0; k < 25; ++k) {
    PointTask point;
    point.desired = {0.06 * (k % 5 - 2), 0.05 * (k / 5 - 2)};
    const Eigen::Vector3d there = movedPoint(kDepth * point.desired.homogeneous(), displacement, desired_scope);
    point.point = there.head<2>() / there.z();
    points.push_back(point);
  }
  return points;
}

const Eigen::Vector4d kDisplacements[] = {{0.0, 0.0, 0.0, 0.0}, {0.05, 0.0, 0.0, 0.0},   {-0.15, 0.1, 0.0, 0.0},
                                          {0.0, 0.0, 0.7, 0.0}, {0.0, 0.0, 0.0, -0.025}, {0.26, -0.26, -0.69, 0.025}};

TEST(PointsError, TellsTheWayBackOfTheScope) {
  for (const double angle : {0.0, 0.5236}) {
    const scope::Geometry scope = scopeOf(angle);
    for (const Eigen::Vector4d& displacement : kDisplacements) {
      PointsError error(PointsConfig(), kDepth);
      const PointsSeen seen = error.from(seenAfter(displacement, scope), kMiddle, scope);
      ASSERT_TRUE(seen.is_known) << displacement.transpose();
      EXPECT_EQ(seen.agreeing, 25);
      scope::Geometry desired_scope = scope;
      desired_scope.d2 -= displacement[3];
      const TaskError truth = moved(TaskError(), displacement, desired_scope, kDepth);
      EXPECT_NEAR(seen.error.x, truth.x, 1e-5);
      EXPECT_NEAR(seen.error.y, truth.y, 1e-5);
      EXPECT_NEAR(seen.error.log_depth, truth.log_depth, 1e-4);
      EXPECT_NEAR(seen.error.alpha, truth.alpha, 1e-5);
      // Not exact: the orientation of an error is that of a region that faces the camera.
      const Eigen::Vector4d none = composed(displacement, displacementToTarget(seen.error, scope, kDepth));
      EXPECT_LE(none.norm(), 0.07 * displacement.norm() + 1e-9) << displacement.transpose() << ", optics at " << angle;
    }
  }
}

// Near the goal the law of the features, with one rate for all, is v = -lambda (D L)^+ D e of the points.
TEST(PointsError, TheFeatureLawBehindItIsTheRobustLaw) {
  const scope::Geometry scope = scopeOf(0.0);
  const std::vector<PointTask> points = seenAfter({2e-3, -1e-3, 3e-3, 1e-4}, scope);
  PointsError error(PointsConfig(), kDepth);
  const PointsSeen seen = error.from(points, kMiddle, scope);
  ASSERT_TRUE(seen.is_known);
  FeatureGains gains;
  gains.centre = gains.depth = gains.orientation = 0.5;
  const Eigen::Vector4d by_features = FeatureLaw(gains).velocity(seen.error, scope).sum().vector();
  std::vector<PointTask> tasks = points;
  for (PointTask& task : tasks) task.depth = kDepth;
  RobustPointLaw law({0.5, 5e-4});
  const Eigen::Vector4d by_points = law.velocity(tasks, scope).velocity.vector();
  EXPECT_LT((by_features - by_points).norm(), 0.02 * by_points.norm()) << by_features.transpose() << "\n"
                                                                       << by_points.transpose();
}

// A third of the points stay where they were in the image; noise of half a pixel at 400 px on all of them.
TEST(PointsError, WhatIsAstrayHasNoSay) {
  const scope::Geometry scope = scopeOf(0.0);
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0.0, 0.5 / 400.0);
  for (const Eigen::Vector4d& displacement : kDisplacements) {
    if (displacement.norm() < 0.02) continue;  // the points astray are then where they belong
    std::vector<PointTask> points = seenAfter(displacement, scope);
    for (std::size_t k = 0; k < points.size(); ++k) {
      if (k % 3 == 1) points[k].point = points[k].desired;
      points[k].point += Eigen::Vector2d(noise(random), noise(random));
    }
    PointsError error(PointsConfig(), kDepth);
    const PointsSeen seen = error.from(points, kMiddle, scope);
    ASSERT_TRUE(seen.is_known) << displacement.transpose();
    EXPECT_LT(seen.stddev, 1.5 / 400.0);
    EXPECT_GE(seen.agreeing, 14);
    const Eigen::Vector4d none = composed(displacement, displacementToTarget(seen.error, scope, kDepth));
    EXPECT_LT(none.head<2>().norm(), 0.003) << displacement.transpose();
    EXPECT_LT(std::abs(none[2]), 0.02) << displacement.transpose();
    EXPECT_LT(std::abs(none[3]), 0.002) << displacement.transpose();
  }
}

TEST(PointsError, IsNotKnownWithoutEnoughPoints) {
  const scope::Geometry scope = scopeOf(0.0);
  PointsError error(PointsConfig(), kDepth);
  EXPECT_FALSE(error.from({}, kMiddle, scope).is_known);
  std::vector<PointTask> points = seenAfter({0.05, 0.0, 0.0, 0.0}, scope);
  for (std::size_t k = 3; k < points.size(); ++k) points[k].weight = 0.0;
  EXPECT_FALSE(error.from(points, kMiddle, scope).is_known) << "three, and four are needed";
  points[3].weight = 1.0;
  EXPECT_TRUE(error.from(points, kMiddle, scope).is_known);
  points[3].point.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(error.from(points, kMiddle, scope).is_known) << "what is not finite does not count";
  for (PointTask& point : points) point.point = point.desired = {0.1, 0.1};
  EXPECT_FALSE(error.from(points, kMiddle, scope).is_known) << "all in one place tell no turn and no depth";
}

}  // namespace
}  // namespace laparoscope_servo::servo
