// The error of 2 1/2 D servoing: the displacement that it tells is the scope's, however the tissue is slanted.
#include "laparoscope_servo/servo/position_error.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "laparoscope_servo/geometry/homography.h"
#include "servo/task/scope_displacement.h"

namespace laparoscope_servo::servo {
namespace {

constexpr double kDepth = 0.08;  // m, Z*
const Eigen::Vector3d kMiddle(0.05, -0.03, 1.0);

scope::Geometry scopeOf(double angle) {
  return {scope::obliqueOptics(angle, 0.3), 0.11};
}

// The current camera, in the reference one's frame.
Eigen::Isometry3d cameraAfter(const Eigen::Vector4d& displacement, const scope::Geometry& now) {
  scope::Geometry reference = now;
  reference.d2 -= displacement[3];
  Eigen::Isometry3d current_T_reference;
  const Eigen::Vector3d origin = movedPoint(Eigen::Vector3d::Zero(), displacement, reference);
  for (int k = 0; k < 3; ++k)
    current_T_reference.linear().col(k) = movedPoint(Eigen::Vector3d::Unit(k), displacement, reference) - origin;
  current_T_reference.translation() = origin;
  current_T_reference.makeAffine();
  return current_T_reference;
}

// Of tissue that is slanted, and kDepth away at the point.
Eigen::Matrix3d homography(const Eigen::Vector4d& displacement, const scope::Geometry& now,
                           const Eigen::Vector3d& slant) {
  const Eigen::Vector3d normal = geometry::so3Exp(slant) * Eigen::Vector3d::UnitZ();
  return geometry::fromPlane(cameraAfter(displacement, now), normal, kDepth * normal.dot(kMiddle));
}

const Eigen::Vector4d kDisplacements[] = {{0.0, 0.0, 0.0, 0.0}, {0.05, 0.0, 0.0, 0.0},   {-0.15, 0.1, 0.0, 0.0},
                                          {0.0, 0.0, 0.7, 0.0}, {0.0, 0.0, 0.0, -0.025}, {0.26, -0.26, -0.69, 0.025}};
const Eigen::Vector3d kSlants[] = {{0.0, 0.0, 0.0}, {0.35, 0.0, 0.0}, {-0.2, 0.3, 0.0}};

TEST(PositionError, TellsTheWayBackOfTheScopeHoweverTheTissueIsSlanted) {
  for (const double angle : {0.0, 0.52}) {
    const scope::Geometry now = scopeOf(angle);
    for (const Eigen::Vector4d& displacement : kDisplacements) {
      for (const Eigen::Vector3d& slant : kSlants) {
        const PositionSeen seen = positionError(-3.0 * homography(displacement, now, slant), kMiddle, now, kDepth);
        ASSERT_TRUE(seen.is_known) << displacement.transpose();
        const Eigen::Vector4d back = displacementToTarget(seen.error, now, kDepth);
        const Eigen::Vector4d total = composed(displacement, back);
        EXPECT_LT(total.norm(), 1e-6) << displacement.transpose() << ", slant " << slant.transpose();
        EXPECT_EQ(seen.error.desired_x, kMiddle.x());
        EXPECT_EQ(seen.error.m_star, kMiddle);
      }
    }
  }
}

// What the region's area says of the depth of slanted tissue is off, the homography is not.
TEST(PositionError, ItsDepthIsThatOfThePoint) {
  const scope::Geometry now = scopeOf(0.0);
  const Eigen::Vector4d displacement(0.2, 0.1, 0.4, 0.02);
  const Eigen::Matrix3d h = homography(displacement, now, {0.35, 0.2, 0.0});
  const Eigen::Vector3d there = cameraAfter(displacement, now) * (kDepth * kMiddle);
  const PositionSeen seen = positionError(h, kMiddle, now, kDepth);
  ASSERT_TRUE(seen.is_known);
  EXPECT_NEAR(seen.error.log_depth, std::log(there.z() / kDepth), 1e-9);
  EXPECT_NEAR(seen.error.x, there.x() / there.z(), 1e-9);
  EXPECT_NEAR(seen.error.y, there.y() / there.z(), 1e-9);
}

// A wrong Z* leaves zero where zero is.
TEST(PositionError, AnErrorOfTheDepthDoesNotMoveTheGoal) {
  const scope::Geometry now = scopeOf(0.3);
  const Eigen::Matrix3d h = homography(Eigen::Vector4d::Zero(), now, {0.3, 0.1, 0.0});
  for (const double factor : {0.5, 2.0}) {
    const PositionSeen seen = positionError(h, kMiddle, now, factor * kDepth);
    ASSERT_TRUE(seen.is_known);
    EXPECT_LT(displacementToTarget(seen.error, now, factor * kDepth).norm(), 1e-7);
  }
}

// The scope moves by `rate` from a place that is displaced, for a moment either way.
TEST(PositionError, TheJacobianIsThatOfTheFeatures) {
  constexpr double kMoment = 1e-6;
  for (const double angle : {0.0, 0.52}) {
    for (const Eigen::Vector4d& displacement : kDisplacements) {
      const scope::Geometry now = scopeOf(angle);
      const auto features = [&](const Eigen::Vector4d& further) {
        scope::Geometry there = now;
        there.d2 += further[3];
        const Eigen::Isometry3d camera = cameraAfter(composed(displacement, further), there);
        const Eigen::Vector3d point = camera * (kDepth * kMiddle);
        return Eigen::Vector4d(point.x() / point.z(), point.y() / point.z(), std::log(point.z()),
                               geometry::so3Log(camera.linear()).z());
      };
      const Eigen::Isometry3d camera = cameraAfter(displacement, now);
      const Eigen::Vector3d point = camera * (kDepth * kMiddle);
      const Eigen::Matrix4d jacobian = positionJacobian(point.x() / point.z(), point.y() / point.z(), point.z(),
                                                        geometry::so3Log(camera.linear()), now);
      for (int k = 0; k < 4; ++k) {
        const Eigen::Vector4d step = kMoment * Eigen::Vector4d::Unit(k);
        const Eigen::Vector4d slope = (features(step) - features(-step)) / (2.0 * kMoment);
        EXPECT_LT((slope - jacobian.col(k)).norm(), 1e-5) << k << " at " << displacement.transpose();
      }
    }
  }
}

TEST(PositionError, NoiseOfTheCornersIsNoiseOfTheError) {
  std::mt19937 random(2);
  std::normal_distribution<double> noise(0.0, 0.3);
  const scope::Geometry now = scopeOf(0.0);
  const geometry::PinholeCamera camera{400.0, 400.0, 319.5, 239.5};
  const geometry::Rectangle roi{290.0, 180.0, 100.0, 100.0};
  const Eigen::Vector3d middle = camera.inverseMatrix() * roi.centre().homogeneous();
  const Eigen::Vector4d displacement(0.05, -0.04, 0.2, 0.01);
  const Eigen::Matrix3d h = geometry::fromPlane(cameraAfter(displacement, now), Eigen::Vector3d::UnitZ(), kDepth);
  const auto corners = geometry::apply(geometry::pixelsFromNormalised(h, camera), roi.corners());
  double squares = 0.0;
  constexpr int kTrials = 200;
  for (int k = 0; k < kTrials; ++k) {
    geometry::Quadrilateral noisy = corners;
    for (Eigen::Vector2d& corner : noisy) corner += Eigen::Vector2d(noise(random), noise(random));
    const Eigen::Matrix3d seen_h = geometry::normalisedFromPixels(geometry::fromCorners(roi.corners(), noisy), camera);
    const PositionSeen seen = positionError(seen_h, middle, now, kDepth);
    ASSERT_TRUE(seen.is_known);
    squares += composed(displacement, displacementToTarget(seen.error, now, kDepth)).squaredNorm();
  }
  EXPECT_LT(std::sqrt(squares / kTrials), 0.02) << "rad and m";
}

TEST(PositionError, NothingIsKnownByAHomographyThatIsNone) {
  const scope::Geometry now = scopeOf(0.0);
  Eigen::Matrix3d nan = Eigen::Matrix3d::Identity();
  nan(1, 2) = std::numeric_limits<double>::quiet_NaN();
  const Eigen::Matrix3d flat = Eigen::Vector3d::UnitZ() * Eigen::RowVector3d(0.0, 0.0, 1.0);
  for (const Eigen::Matrix3d& h : {nan, flat, Eigen::Matrix3d(Eigen::Matrix3d::Zero())}) {
    const PositionSeen seen = positionError(h, kMiddle, now, kDepth);
    EXPECT_FALSE(seen.is_known);
    EXPECT_TRUE(isFinite(seen.error));
  }
}

}  // namespace
}  // namespace laparoscope_servo::servo
