#include "features/points/point_motion.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <vector>

namespace laparoscope_servo::features {
namespace {

std::vector<Eigen::Vector2d> grid() {
  std::vector<Eigen::Vector2d> points;
  for (int j = 0; j < 4; ++j) {
    for (int i = 0; i < 5; ++i) points.emplace_back(40.0 + 60.0 * i + 7.0 * j, 30.0 + 50.0 * j);
  }
  return points;
}

Eigen::Vector2d moved(const Eigen::Vector2d& p) {
  return Eigen::Vector2d(12.0, -7.0) + 1.08 * (Eigen::Rotation2Dd(0.1) * p);
}

TEST(PointMotion, FindsTheSimilarityOfMostPoints) {
  PointMotion motion(21.0);
  motion.reserve(20);
  const auto points = grid();
  for (std::size_t k = 0; k < points.size(); ++k) {
    const bool astray = k % 4 == 1;
    motion.add(points[k], moved(points[k]) + (astray ? Eigen::Vector2d(25.0, -30.0) : Eigen::Vector2d(0.0, 0.0)));
  }
  ASSERT_TRUE(motion.fit());
  const Eigen::Matrix2d expected = 1.08 * Eigen::Rotation2Dd(0.1).toRotationMatrix();
  EXPECT_LT((motion.linear() - expected).norm(), 1e-3);
  for (const Eigen::Vector2d& p : points) EXPECT_LT((motion.apply(p) - moved(p)).norm(), 0.05);
  EXPECT_LT((motion.apply({150.0, 90.0}) - moved({150.0, 90.0})).norm(), 0.05);
}

// A bulge: each point is led by its neighbours.
TEST(PointMotion, FollowsTheNeighboursWhereTissueDeforms) {
  const auto bulge = [](const Eigen::Vector2d& p) {
    const double near = (p - Eigen::Vector2d(160.0, 105.0)).squaredNorm() / (80.0 * 80.0);
    return Eigen::Vector2d(0.0, 2.5 * std::exp(-near));
  };
  PointMotion motion(21.0);
  for (const Eigen::Vector2d& p : grid()) motion.add(p, moved(p) + bulge(p));
  ASSERT_TRUE(motion.fit());
  const Eigen::Vector2d asked(165.0, 100.0);
  const Eigen::Vector2d by_similarity = motion.linear() * (asked - Eigen::Vector2d(400.0, 400.0)) +
                                        motion.apply({400.0, 400.0});  // far from all: the similarity alone
  const double with = (motion.apply(asked) - moved(asked) - bulge(asked)).norm(),
               without = (by_similarity - moved(asked) - bulge(asked)).norm();
  EXPECT_LT(with, 0.75 * without);
}

TEST(PointMotion, OfOnePointIsItsShiftAndOfNoneNothing) {
  PointMotion motion(21.0);
  motion.reserve(3);
  EXPECT_FALSE(motion.fit());
  EXPECT_EQ(motion.apply({5.0, 6.0}), Eigen::Vector2d(5.0, 6.0));
  motion.add({100.0, 50.0}, {103.0, 46.0});
  ASSERT_TRUE(motion.fit());
  EXPECT_LT((motion.apply({200.0, 150.0}) - Eigen::Vector2d(203.0, 146.0)).norm(), 1e-6);
  motion.clear();
  EXPECT_FALSE(motion.fit());
  EXPECT_EQ(motion.apply({5.0, 6.0}), Eigen::Vector2d(5.0, 6.0));
}

}  // namespace
}  // namespace laparoscope_servo::features
