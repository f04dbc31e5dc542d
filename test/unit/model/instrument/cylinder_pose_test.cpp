#include "laparoscope_servo/model/cylinder_pose.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <cmath>

namespace laparoscope_servo::model {
namespace {

constexpr geometry::PinholeCamera kCamera{800.0, 790.0, 320.0, 240.0};

struct Cylinder {
  Eigen::Vector3d tip{0.01, -0.005, 0.09};
  Eigen::Vector3d direction = Eigen::Vector3d(-0.8, 0.2, 0.4).normalized();
  double radius = 0.004;
};

// The planes through the camera that touch the cylinder, as lines of the image: right and left of who looks to the tip.
std::array<OutlineLine, 2> outline(const Cylinder& c) {
  const Eigen::Vector3d foot = c.tip - c.direction * c.direction.dot(c.tip);
  const double distance = foot.norm();
  const Eigen::Vector3d towards = foot / distance, side = c.direction.cross(towards);
  const double sine = c.radius / distance, cosine = std::sqrt(1.0 - sine * sine);
  std::array<OutlineLine, 2> lines;
  for (const double sign : {1.0, -1.0}) {
    const Eigen::Vector3d n = sign * cosine * side - sine * towards;  // away from the cylinder
    const Eigen::Vector3d l = kCamera.inverseMatrix().transpose() * n;
    OutlineLine line;
    const double size = l.head<2>().norm();
    line.theta = std::atan2(l.y(), l.x());
    line.rho = -l.z() / size;
    line.covariance << 0.04, 0.0, 0.0, 1e-6;
    // Who looks along the axis has the right edge's normal at +90 degrees from it, y downwards.
    const Eigen::Vector3d ahead = c.tip + 0.001 * c.direction;
    const Eigen::Vector2d axis = ahead.head<2>() / ahead.z() - c.tip.head<2>() / c.tip.z();
    const bool right = -axis.y() * std::cos(line.theta) + axis.x() * std::sin(line.theta) > 0.0;
    lines[right ? 0 : 1] = line;
  }
  return lines;
}

Eigen::Vector2d project(const Eigen::Vector3d& p) {
  return {kCamera.fx * p.x() / p.z() + kCamera.cx, kCamera.fy * p.y() / p.z() + kCamera.cy};
}

TEST(CylinderPose, FindsAxisAndTipOfAKnownCylinder) {
  const Cylinder c;
  const auto pose = cylinderPose(kCamera, c.radius, outline(c), project(c.tip), 1.0);
  ASSERT_TRUE(pose);
  EXPECT_LT((pose->direction - c.direction).norm(), 1e-6);
  EXPECT_LT((pose->point - c.tip).norm(), 1e-6);
}

TEST(CylinderPose, TurningItAroundSwapsTheEdgesAndTheDirection) {
  Cylinder c;
  auto lines = outline(c);
  std::swap(lines[0], lines[1]);
  const auto pose = cylinderPose(kCamera, c.radius, lines);
  ASSERT_TRUE(pose);
  EXPECT_LT((pose->direction + c.direction).norm(), 1e-6);
}

TEST(CylinderPose, WithoutTipSlidingIsOpenAndRollAlways) {
  const Cylinder c;
  const auto without = cylinderPose(kCamera, c.radius, outline(c));
  const auto with = cylinderPose(kCamera, c.radius, outline(c), project(c.tip), 4.0);
  ASSERT_TRUE(without && with);
  const auto along = [](const CylinderPose& p, int at) {
    return p.direction.dot(p.covariance.block<3, 3>(at, at) * p.direction);
  };
  EXPECT_GT(along(*without, 0), 0.5 * CylinderPose::kOpen);
  EXPECT_LT(along(*with, 0), 1e-3 * 1e-3);
  EXPECT_GT(along(*without, 3), 0.5 * CylinderPose::kOpen);
  EXPECT_GT(along(*with, 3), 0.5 * CylinderPose::kOpen);
  // It is known across the axis, though.
  const Eigen::Vector3d across = c.direction.unitOrthogonal();
  EXPECT_LT(across.dot(without->covariance.topLeftCorner<3, 3>() * across), 0.01 * 0.01);
}

// The covariance is that of the poses that lines with such errors lead to.
TEST(CylinderPose, CovarianceIsWhatErrorsOfTheLinesDo) {
  const Cylinder c;
  const auto lines = outline(c);
  const auto pose = cylinderPose(kCamera, c.radius, lines, project(c.tip), 0.0);
  ASSERT_TRUE(pose);
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  // The four errors one by one, one standard deviation each: their squares add up.
  for (int k = 0; k < 4; ++k) {
    auto other = lines;
    OutlineLine& line = other[static_cast<std::size_t>(k / 2)];
    const double scale = 0.01;  // so small that the pose changes linearly
    (k % 2 == 0 ? line.rho : line.theta) += scale * std::sqrt(line.covariance(k % 2, k % 2));
    const auto moved = cylinderPose(kCamera, c.radius, other, project(c.tip), 0.0);
    ASSERT_TRUE(moved);
    const Eigen::Vector3d change = (moved->point - pose->point) / scale;
    sum += change * change.transpose();
  }
  EXPECT_LT((pose->covariance.topLeftCorner<3, 3>() - sum).norm(), 0.02 * sum.norm());
}

TEST(CylinderPose, RefusesWhatIsNoOutline) {
  const Cylinder c;
  auto lines = outline(c);
  EXPECT_FALSE(cylinderPose(kCamera, 0.0, lines));
  EXPECT_FALSE(cylinderPose(kCamera, std::nan(""), lines));
  EXPECT_FALSE(cylinderPose(geometry::PinholeCamera{}, c.radius, lines));
  lines[1] = lines[0];
  EXPECT_FALSE(cylinderPose(kCamera, c.radius, lines));
  lines[1].rho = std::nan("");
  EXPECT_FALSE(cylinderPose(kCamera, c.radius, lines));
}

}  // namespace
}  // namespace laparoscope_servo::model
