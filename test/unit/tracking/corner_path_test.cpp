#include "laparoscope_servo/tracking/corner_path.h"

#include <gtest/gtest.h>

namespace laparoscope_servo::tracking {
namespace {

geometry::Quadrilateral at(double x) {
  return geometry::Rectangle{x, 20.0, 100.0, 50.0}.corners();
}

TEST(CornerPath, IsFarthestFromAnyOfTheLastImages) {
  CornerPath path;
  EXPECT_EQ(path.farthest(at(0.0), 5), 0.0) << "nothing is known";
  for (const double x : {10.0, 1.0, 2.0}) path.add(at(x));
  EXPECT_EQ(path.farthest(at(3.0), 0), 0.0);
  EXPECT_DOUBLE_EQ(path.farthest(at(3.0), 1), 1.0);
  EXPECT_DOUBLE_EQ(path.farthest(at(3.0), 2), 2.0);
  EXPECT_DOUBLE_EQ(path.farthest(at(3.0), 3), 7.0);
  EXPECT_DOUBLE_EQ(path.farthest(at(3.0), 1000), 7.0);
  path.clear();
  EXPECT_EQ(path.farthest(at(3.0), 3), 0.0);
}

TEST(CornerPath, CountsTheCornerThatMovesMost) {
  CornerPath path;
  path.add(at(0.0));
  geometry::Quadrilateral corners = at(1.0);
  corners[2].y() += 30.0;
  EXPECT_NEAR(path.farthest(corners, 1), std::hypot(1.0, 30.0), 1e-12);
}

TEST(CornerPath, PassesOverImagesInWhichTheRegionWasNotTracked) {
  CornerPath path;
  path.add(at(0.0));
  path.add(std::nullopt);
  EXPECT_EQ(path.farthest(at(3.0), 1), 0.0);
  EXPECT_DOUBLE_EQ(path.farthest(at(3.0), 2), 3.0);
}

TEST(CornerPath, ForgetsWhatIsLongAgo) {
  CornerPath path;
  path.add(at(100.0));
  for (std::size_t k = 0; k < CornerPath::kMemory; ++k) path.add(at(0.0));
  EXPECT_EQ(path.farthest(at(0.0), 1000), 0.0);
}

}  // namespace
}  // namespace laparoscope_servo::tracking
