#include "features/dot_outline.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <vector>

namespace laparoscope_servo::features {
namespace {

TEST(DotOutline, distancesFromACircleAreThoseFromItsCentreLessTheRadius) {
  constexpr double kRadius = 7.3;
  const DotOutline circle(Eigen::Matrix2d::Identity() / (kRadius * kRadius), kRadius);
  const Eigen::Vector2d centre(20.4, 15.0);
  std::vector<float> row(41);
  for (int v = 0; v < 30; ++v) {
    circle.distances({3, v}, centre, static_cast<int>(row.size()), row.data());
    for (std::size_t k = 0; k < row.size(); ++k) {
      const double expected = (Eigen::Vector2d(3.0 + static_cast<double>(k), v) - centre).norm() - kRadius;
      EXPECT_NEAR(static_cast<double>(row[k]), expected, 1e-4) << k << ", " << v;
    }
  }
}

TEST(DotOutline, anEllipseIsZeroOnItsOutlineWithASlopeOfOneAcross) {
  const double a = 9.0, b = 5.0, turn = 0.6;
  const Eigen::Matrix2d axes = Eigen::Rotation2Dd(turn).toRotationMatrix();
  const DotOutline ellipse(axes * Eigen::Vector2d(1.0 / (a * a), 1.0 / (b * b)).asDiagonal() * axes.transpose(), b);
  for (double phi = 0.0; phi < 6.2; phi += 0.3) {
    const Eigen::Vector2d on = axes * Eigen::Vector2d(a * std::cos(phi), b * std::sin(phi));
    const Eigen::Vector2d normal = (axes * Eigen::Vector2d(b * std::cos(phi), a * std::sin(phi))).normalized();
    for (const double away : {-0.2, 0.0, 0.2}) {
      float found = 0.0f;  // at the pixel (0, 0), which lies so far from the centre
      ellipse.distances({0, 0}, -(on + away * normal), 1, &found);
      EXPECT_NEAR(static_cast<double>(found), away, 0.01) << phi;
    }
  }
}

TEST(DotOutline, theCentreIsTheSmallerRadiusInside) {
  const DotOutline ellipse(Eigen::Vector2d(1.0 / 81.0, 1.0 / 25.0).asDiagonal(), 5.0);
  float found = 0.0f;
  ellipse.distances({4, 6}, {4.0, 6.0}, 1, &found);
  EXPECT_EQ(found, -5.0f);
}

TEST(DotOutline, theCentreHasTheSectorOfTheAngleZero) {
  EXPECT_EQ(sectorOf(0.0, 0.0), sectorOf(1.0, 0.0));
  EXPECT_EQ(sectorOf(0.0, 0.0), kSectors / 2);
}

TEST(DotOutline, sectorsAreThoseOfTheAngle) {
  for (int degree = -179; degree < 180; degree += 2) {  // no border of a sector, which either may have
    const double angle = degree * M_PI / 180.0;
    const int expected = static_cast<int>((angle / (2.0 * M_PI) + 0.5) * kSectors);
    EXPECT_EQ(sectorOf(3.0 * std::cos(angle), 3.0 * std::sin(angle)), expected) << degree;
  }
}

}  // namespace
}  // namespace laparoscope_servo::features
