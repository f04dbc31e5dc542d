#include "screen/space/space_shapes.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

namespace laparoscope_servo::screen {
namespace {

const geometry::PinholeCamera kCamera{400.0, 410.0, 319.5, 239.5};
const std::array<double, 8> kRegion{260, 180, 379, 180, 379, 299, 260, 299};
const std::array<double, 9> kIdentity{1, 0, 0, 0, 1, 0, 0, 0, 1};
constexpr double kDepth = 0.08;

Eigen::Vector3d rayOf(std::size_t corner) {
  return kCamera.inverseMatrix() * Eigen::Vector3d(kRegion[2 * corner], kRegion[2 * corner + 1], 1.0);
}

// What the camera sees after it has moved by `motion` (coordinates before to after) in front of the plane z = kDepth.
std::array<double, 9> homography(const Eigen::Isometry3d& motion, double scale) {
  const Eigen::Matrix3d h = motion.linear() + motion.translation() * Eigen::RowVector3d(0.0, 0.0, 1.0 / kDepth);
  const Eigen::Matrix3d g = scale * (kCamera.matrix() * h * kCamera.inverseMatrix());
  std::array<double, 9> values{};
  Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(values.data()) = g;
  return values;
}

TEST(SpaceShapes, TheRegionLiesWhereThePlaneHasGone) {
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  motion.rotate(Eigen::AngleAxisd(0.3, Eigen::Vector3d(1.0, -2.0, 0.5).normalized()));
  motion.translation() = Eigen::Vector3d(0.01, -0.005, 0.02);
  for (const double scale : {1.0, 0.3, 7.0}) {
    const auto corners = regionInSpace(kCamera, homography(motion, scale), kRegion, kDepth);
    ASSERT_TRUE(corners);
    for (std::size_t k = 0; k < 4; ++k) {
      EXPECT_LT(((*corners)[k] - motion * Eigen::Vector3d(kDepth * rayOf(k))).norm(), 1e-9) << k;
    }
  }
}

TEST(SpaceShapes, NothingIsDrawnOfWhatCannotBe) {
  EXPECT_FALSE(regionInSpace({}, kIdentity, kRegion, kDepth));
  EXPECT_FALSE(regionInSpace(kCamera, kIdentity, kRegion, 0.0));
  EXPECT_FALSE(regionInSpace(kCamera, kIdentity, kRegion, std::numeric_limits<double>::quiet_NaN()));
  EXPECT_FALSE(regionInSpace(kCamera, {}, kRegion, kDepth)) << "no homography";
  EXPECT_FALSE(regionInSpace(kCamera, {-1, 0, 0, 0, -1, 0, 0, 0, -1}, kRegion, kDepth)) << "behind the camera";
  std::array<double, 9> g = kIdentity;
  g[4] = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(regionInSpace(kCamera, g, kRegion, kDepth));
}

TEST(SpaceShapes, BoundsLieBetweenTheTwoDepthsWithinTheCone) {
  for (const double cone : {0.0, 0.4, 1.2, 2.5}) {
    const ScopeBounds bounds{0.03, 0.22, cone, {0.2, 0.1, -2.0}};
    const Lines lines = boundLines(bounds);
    ASSERT_FALSE(lines.empty());
    double least = 1.0, greatest = 0.0, widest = 0.0;
    for (const auto& [from, to] : lines) {
      for (const Eigen::Vector3d& end : {from, to}) {
        least = std::min(least, end.norm());
        greatest = std::max(greatest, end.norm());
        widest = std::max(widest, std::acos(std::min(1.0, end.normalized().dot(bounds.axis.normalized()))));
      }
    }
    EXPECT_NEAR(least, 0.03, 1e-9);
    EXPECT_NEAR(greatest, 0.22, 1e-9);
    EXPECT_NEAR(widest, cone, 1e-6);
  }
}

TEST(SpaceShapes, BoundsThatAreNoneAreNotDrawn) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(boundLines({}).empty());
  EXPECT_TRUE(boundLines({0.2, 0.1, 1.0, {0, 0, -1}}).empty());
  EXPECT_TRUE(boundLines({0.1, 0.2, nan, {0, 0, -1}}).empty());
  EXPECT_TRUE(boundLines({0.1, 0.2, 1.0, {0, 0, 0}}).empty());
  EXPECT_TRUE(boundLines({0.1, 0.2, 1.0, {0, nan, 0}}).empty());
  EXPECT_TRUE(boundLines({0.1, std::numeric_limits<double>::infinity(), 1.0, {0, 0, -1}}).empty());
}

TEST(SpaceShapes, AnEllipsoidHasTwiceTheStandardDeviations) {
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  const Eigen::Vector3d deviations(0.001, 0.002, 0.005);
  const Eigen::Matrix3d covariance = turn * deviations.cwiseAbs2().asDiagonal() * turn.transpose();
  const auto ellipsoid = ellipsoidOf(covariance);
  ASSERT_TRUE(ellipsoid);
  EXPECT_NEAR(ellipsoid->axes.determinant(), 1.0, 1e-9);
  EXPECT_LT((ellipsoid->radii - 2.0 * deviations).norm(), 1e-9);
  const Eigen::Matrix3d back =
      ellipsoid->axes * (0.25 * ellipsoid->radii.cwiseAbs2()).asDiagonal() * ellipsoid->axes.transpose();
  EXPECT_LT((back - covariance).norm(), 1e-12);
}

TEST(SpaceShapes, WhatIsNoCovarianceHasNoEllipsoid) {
  EXPECT_FALSE(ellipsoidOf(Eigen::Matrix3d::Zero()));
  EXPECT_FALSE(ellipsoidOf(-Eigen::Matrix3d::Identity()));
  EXPECT_FALSE(ellipsoidOf(Eigen::Vector3d(1.0, 1.0, -0.5).asDiagonal()));
  EXPECT_FALSE(ellipsoidOf(Eigen::Matrix3d::Constant(std::numeric_limits<double>::quiet_NaN())));
}

}  // namespace
}  // namespace laparoscope_servo::screen
