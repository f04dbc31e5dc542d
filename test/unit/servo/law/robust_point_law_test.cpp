#include "laparoscope_servo/servo/robust_point_law.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "laparoscope_servo/geometry/se3.h"

namespace laparoscope_servo::servo {
namespace {

using Cloud = std::vector<Eigen::Vector3d>;  // m, in the camera's frame

const scope::Geometry kStraight{Eigen::Matrix3d::Identity(), 0.15};

Cloud tissue(int count) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> across(-0.03, 0.03), deep(0.07, 0.10);
  Cloud result;
  for (int k = 0; k < count; ++k) result.emplace_back(across(random), across(random), deep(random));
  return result;
}

// As the camera sees a resting scene when the scope moves for `time`.
Cloud moved(const Cloud& cloud, const scope::Geometry& scope, const Eigen::Vector4d& velocity, double time) {
  const geometry::Vector6d twist = scope::insertionPointMotions(scope) * velocity;
  const Eigen::Vector3d v = twist.head<3>(), w = twist.tail<3>();
  Cloud result;
  for (const Eigen::Vector3d& p : cloud) result.push_back(geometry::so3Exp(-time * w) * (p - time * v));
  return result;
}

std::vector<PointTask> tasks(const Cloud& now, const Cloud& wanted) {
  std::vector<PointTask> result;
  for (std::size_t k = 0; k < now.size(); ++k) {
    result.push_back({now[k].head<2>() / now[k].z(), wanted[k].head<2>() / wanted[k].z(), now[k].z(), 1.0});
  }
  return result;
}

double largestError(const std::vector<PointTask>& points) {
  double largest = 0.0;
  for (const PointTask& task : points) largest = std::max(largest, (task.point - task.desired).norm());
  return largest;
}

TEST(PointJacobian, isTheDerivativeOfWhatIsSeen) {
  const Cloud cloud = tissue(20);
  scope::Geometry oblique = kStraight;
  oblique.camera_R_shaft = scope::obliqueOptics(30.0 * M_PI / 180.0, 0.4);
  for (const scope::Geometry& scope : {kStraight, oblique}) {
    for (int c = 0; c < 4; ++c) {
      const Eigen::Vector4d direction = Eigen::Vector4d::Unit(c);
      const Cloud ahead = moved(cloud, scope, direction, 1e-5), behind = moved(cloud, scope, direction, -1e-5);
      for (std::size_t k = 0; k < cloud.size(); ++k) {
        const Eigen::Vector2d numeric =
            (ahead[k].head<2>() / ahead[k].z() - behind[k].head<2>() / behind[k].z()) / 2e-5;
        const Eigen::Vector2d at = cloud[k].head<2>() / cloud[k].z();
        EXPECT_LT((pointJacobian(at, cloud[k].z(), scope).col(c) - numeric).norm(), 1e-5 * (1.0 + numeric.norm()));
      }
    }
  }
}

// A third of the points lies on something else, and stays away from where they shall be.
TEST(RobustPointLaw, reachesTheGoalWithAThirdOfThePointsAstray) {
  const Cloud wanted = tissue(60);
  Cloud now = moved(wanted, kStraight, {0.10, -0.08, 0.2, 0.01}, 1.0);
  RobustPointLaw law({0.5, 5e-4});
  std::mt19937 random(9);
  std::uniform_real_distribution<double> far(-0.2, 0.2);
  std::vector<Eigen::Vector2d> astray(20);
  for (Eigen::Vector2d& by : astray) by = {far(random) + 0.15, far(random)};
  scope::Geometry scope = kStraight;
  const double first = largestError(tasks(now, wanted));
  double before = first;
  for (int step = 0; step < 200; ++step) {
    std::vector<PointTask> points = tasks(now, wanted);
    for (std::size_t k = 0; k < astray.size(); ++k) points[3 * k].point += astray[k];
    const RobustPointVelocity result = law.velocity(points, scope);
    ASSERT_TRUE(result.is_determined);
    now = moved(now, scope, result.velocity.vector(), 0.1);
    scope.d2 += 0.1 * result.velocity.insertion;
    const double error = largestError(tasks(now, wanted));
    EXPECT_LT(error, before + 1e-3) << step;
    before = error;
  }
  // All points alike would leave a third of the mean error of those astray, 0.05.
  EXPECT_GT(first, 0.4);
  EXPECT_LT(before, 0.01 * first);
  for (std::size_t k = 0; k < 60; ++k) {
    if (k % 3 != 0) {
      EXPECT_GT(law.weights()[k], 0.5) << k;
    } else if (astray[k / 3].norm() > 0.05) {
      EXPECT_LT(law.weights()[k], 0.01) << k;
    }
  }
}

TEST(RobustPointLaw, errorsDecayWithTheRate) {
  const Cloud wanted = tissue(12);
  const Cloud now = moved(wanted, kStraight, {0.01, 0.02, -0.03, 0.002}, 1.0);
  for (const double rate : {0.5, 2.0}) {
    RobustPointLaw law({rate, 5e-4});
    const Eigen::Vector4d velocity = law.velocity(tasks(now, wanted), kStraight).velocity.vector();
    EXPECT_LT((velocity + rate * Eigen::Vector4d(0.01, 0.02, -0.03, 0.002)).norm(), 0.03 * velocity.norm());
  }
}

TEST(RobustPointLaw, saysWhatDoesNotDetermineAVelocity) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  RobustPointLaw law({});
  std::vector<PointTask> points = tasks(tissue(8), tissue(8));
  EXPECT_FALSE(law.velocity({}, kStraight).is_determined);
  EXPECT_FALSE(law.velocity({points[0]}, kStraight).is_determined);
  // What is not finite, lies behind the camera, or has no weight, is not used; the others are.
  points[0].point.x() = nan;
  points[1].depth = -0.1;
  points[2].weight = 0.0;
  points[3].depth = nan;
  const RobustPointVelocity result = law.velocity(points, kStraight);
  EXPECT_TRUE(result.is_determined);
  EXPECT_LT(result.velocity.vector().norm(), 1e-9);
  for (std::size_t k = 0; k < points.size(); ++k) EXPECT_EQ(law.weights()[k] > 0.0, k > 3) << k;
  for (PointTask& task : points) task.depth = nan;
  EXPECT_FALSE(law.velocity(points, kStraight).is_determined);
  EXPECT_TRUE(law.velocity(points, kStraight).velocity.isZero());
}

}  // namespace
}  // namespace laparoscope_servo::servo
