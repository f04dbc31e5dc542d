#include "features/points/point_search.h"

#include <gtest/gtest.h>

#include "seen.h"
#include "support/synthetic_tissue.h"

namespace laparoscope_servo::features {
namespace {

const Eigen::Vector2d kPlace(100.0, 80.0);

class PointSearchTest : public testing::Test {
 protected:
  PointSearchTest() { view_.take(seen(picture_), kPlace, 10); }
  cv::Mat picture_ = test::tissue({200, 160}, 5);
  PointView view_;
  PointSearch search_{16.0, 10};
};

TEST_F(PointSearchTest, FindsWhereTheImageShowsItWithinTheRange) {
  for (const Eigen::Vector2d& off :
       {Eigen::Vector2d(14.0, -12.0), Eigen::Vector2d(-15.0, 3.0), Eigen::Vector2d(0, 0)}) {
    PointPose pose;
    pose.place = kPlace + off;
    ASSERT_TRUE(search_.find(view_, seen(picture_), pose));
    EXPECT_LE((pose.place - kPlace).lpNorm<Eigen::Infinity>(), 1.0) << off.transpose();
  }
  PointPose far;
  far.place = kPlace + Eigen::Vector2d(30.0, 0.0);
  search_.find(view_, seen(picture_), far);
  EXPECT_GT((far.place - kPlace).norm(), 10.0);
}

TEST_F(PointSearchTest, TellsTheLight) {
  PointPose pose;
  pose.place = kPlace + Eigen::Vector2d(6.0, 4.0);
  ASSERT_TRUE(search_.find(view_, seen(test::view(picture_, Eigen::Matrix3d::Identity(), 0.7, 20.0)), pose));
  EXPECT_LE((pose.place - kPlace).lpNorm<Eigen::Infinity>(), 1.0);
  EXPECT_NEAR(pose.gain, 1.0 / 0.7, 0.1);
  EXPECT_NEAR(pose.offset, -20.0 / 0.7, 10.0);
}

TEST_F(PointSearchTest, FindsItTurnedAndLargerWhereThatIsKnown) {
  const Eigen::Matrix2d shape = 1.6 * Eigen::Rotation2Dd(0.8).toRotationMatrix();
  Eigen::Matrix3d g = Eigen::Matrix3d::Identity();
  g.topLeftCorner<2, 2>() = shape;
  g.topRightCorner<2, 1>() = kPlace - shape * kPlace;
  PointPose pose;
  pose.place = kPlace + Eigen::Vector2d(9.0, -7.0);
  pose.shape = shape;
  ASSERT_TRUE(search_.find(view_, seen(test::view(picture_, g)), pose));
  EXPECT_LE((pose.place - kPlace).lpNorm<Eigen::Infinity>(), 2.5);
}

TEST_F(PointSearchTest, SaysNothingOutsideOfTheImageOrWithoutAShape) {
  PointPose pose;
  pose.place = {-1.0, 50.0};
  EXPECT_FALSE(search_.find(view_, seen(picture_), pose));
  pose.place = kPlace;
  pose.shape.setZero();
  EXPECT_FALSE(search_.find(view_, seen(picture_), pose));
  EXPECT_EQ(pose.place, kPlace);
}

}  // namespace
}  // namespace laparoscope_servo::features
