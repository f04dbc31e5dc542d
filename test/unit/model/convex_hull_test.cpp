#include "model/convex_hull.h"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>

namespace laparoscope_servo::model {
namespace {

using Points = std::vector<Eigen::Vector2d>;

Points hullOf(Points points) {
  Points hull;
  convexHull(points, hull);
  return hull;
}

TEST(ConvexHull, hasTheCornersOnceAndTheFirstAgain) {
  const Points hull = hullOf({{2, 1}, {0, 0}, {4, 0}, {2, 0}, {4, 3}, {0, 3}, {1, 1}, {0, 0}, {4, 2}});
  EXPECT_EQ(hull, (Points{{0, 0}, {4, 0}, {4, 3}, {0, 3}, {0, 0}}));
}

TEST(ConvexHull, isThatOfFewPointsAndOfALine) {
  EXPECT_TRUE(hullOf({}).empty());
  EXPECT_EQ(hullOf({{3, 4}, {3, 4}}), (Points{{3, 4}}));
  EXPECT_EQ(hullOf({{3, 4}, {1, 2}}), (Points{{1, 2}, {3, 4}}));
  EXPECT_EQ(hullOf({{2, 2}, {0, 0}, {3, 3}, {1, 1}}), (Points{{0, 0}, {3, 3}, {0, 0}}));
}

TEST(ConvexHull, holdsAllPointsAndTurnsOneWayOnly) {
  cv::RNG random(5);
  Points points(60);
  for (Eigen::Vector2d& point : points) point = {random.uniform(0.0, 100.0), random.uniform(0.0, 80.0)};
  const Points hull = hullOf(points);
  ASSERT_GE(hull.size(), 4u);
  EXPECT_LE(hull.size(), points.size() + 1);
  EXPECT_EQ(hull.front(), hull.back());
  for (std::size_t k = 0; k + 1 < hull.size(); ++k) {
    const Eigen::Vector2d side = hull[k + 1] - hull[k];
    for (const Eigen::Vector2d& point : points) {
      const Eigen::Vector2d to = point - hull[k];
      EXPECT_GE(side.x() * to.y() - side.y() * to.x(), -1e-9);
    }
  }
}

}  // namespace
}  // namespace laparoscope_servo::model
