#include "features/points/tracked_point.h"

#include <gtest/gtest.h>

#include <cmath>

#include "points_check.h"
#include "seen.h"

namespace laparoscope_servo::features {
namespace {

TEST(TrackedPoint, IsPutWhereAMotionTakesItWithItsShape) {
  PointPose pose;
  const Eigen::Matrix3d g = motion({5.0, -3.0}, 0.4, 1.3);
  placeBy(g, {100.0, 90.0}, pose);
  EXPECT_LT((pose.place - geometry::apply(g, Eigen::Vector2d(100.0, 90.0))).norm(), 1e-9);
  EXPECT_LT((pose.shape - 1.3 * Eigen::Rotation2Dd(0.4).toRotationMatrix()).norm(), 1e-9);
  const PointPose before = pose;
  Eigen::Matrix3d mirror = Eigen::Matrix3d::Identity();
  mirror(0, 0) = -1.0;
  for (const Eigen::Matrix3d& none : {mirror, Eigen::Matrix3d(Eigen::Matrix3d::Zero())}) {
    placeBy(none, {100.0, 90.0}, pose);
    EXPECT_EQ(pose.place, before.place);
    EXPECT_EQ(pose.shape, before.shape);
  }
}

class PointComparerTest : public testing::Test {
 protected:
  PointComparerTest() {
    point_.view.take(seen(scene_), place_, 10);
    point_.pose.place = place_;
  }

  const cv::Mat scene_ = test::tissue(kSize, 21);
  const Eigen::Vector2d place_{150.0, 110.0};
  PointComparer comparer_{PointsConfig()};
  TrackedPoint point_{StateConfig()};
};

TEST_F(PointComparerTest, ComparesNextToThePoseAndLooksFurther) {
  const Eigen::Matrix3d g = motion({13.0, -9.0});
  const PointImage now = seen(test::view(scene_, g, 1.0, 0.0, 1.0));
  comparer_.compare(now, point_);
  EXPECT_FALSE(point_.isSeen());
  comparer_.look(now, point_);
  ASSERT_TRUE(point_.isSeen()) << reasonText(point_.reason);
  EXPECT_LT((point_.pose.place - geometry::apply(g, place_)).norm(), 0.1);
  comparer_.compare(now, point_);
  EXPECT_TRUE(point_.isSeen());
}

TEST_F(PointComparerTest, LeavesThePoseWhereNothingIsFound) {
  comparer_.look(seen(test::tissue(kSize, 50)), point_);
  EXPECT_FALSE(point_.isSeen());
  EXPECT_EQ(point_.pose.place, place_);
  point_.pose.place = {-20.0, 50.0};
  comparer_.look(seen(scene_), point_);
  EXPECT_EQ(point_.reason, Reason::kOutside);
}

}  // namespace
}  // namespace laparoscope_servo::features
