#include "features/points/point_flow.h"

#include <gtest/gtest.h>

#include "seen.h"
#include "support/synthetic_tissue.h"

namespace laparoscope_servo::features {
namespace {

const Eigen::Vector2d kPlace(160.0, 120.0);

class PointFlowTest : public testing::Test {
 protected:
  PointFlowTest() { memory_.keep(seen(picture_), kPlace, 7); }

  // How far from the truth it ends.
  double errorOf(const Eigen::Vector2d& shift, int finest, double gain = 1.0, double bias = 0.0) {
    Eigen::Matrix3d g = Eigen::Matrix3d::Identity();
    g.topRightCorner<2, 1>() = shift;
    Eigen::Vector2d place = kPlace;
    if (!flow_.follow(memory_, seen(test::view(picture_, g, gain, bias, 1.0, 7)), finest, place)) return 1e9;
    return (place - kPlace - shift).norm();
  }

  cv::Mat picture_ = test::tissue({320, 240}, 8);
  FlowMemory memory_;
  PointFlow flow_{7};
};

TEST_F(PointFlowTest, FollowsShiftsNearAndFar) {
  for (const Eigen::Vector2d& shift : {Eigen::Vector2d(0.0, 0.0), Eigen::Vector2d(0.6, -0.3), Eigen::Vector2d(7.2, 4.1),
                                       Eigen::Vector2d(-19.0, 12.0)}) {
    EXPECT_LT(errorOf(shift, 0), 0.15) << shift.transpose();
    EXPECT_LT(errorOf(shift, 1), 0.5) << shift.transpose();
  }
}

TEST_F(PointFlowTest, TakesNoChangeOfTheLightForAMotion) {
  EXPECT_LT(errorOf({3.3, -2.4}, 0, 0.7, 0.0), 0.2);
  EXPECT_LT(errorOf({3.3, -2.4}, 0, 1.0, 30.0), 0.2);
}

TEST_F(PointFlowTest, SaysNothingWhereNothingTells) {
  Eigen::Vector2d place = kPlace;
  FlowMemory flat;
  flat.keep(seen(cv::Mat(240, 320, CV_8UC1, cv::Scalar(90))), kPlace, 7);
  EXPECT_FALSE(flow_.follow(flat, seen(picture_), 0, place));
  EXPECT_EQ(place, kPlace);
  memory_.forget();
  EXPECT_FALSE(flow_.follow(memory_, seen(picture_), 0, place));
}

TEST_F(PointFlowTest, FollowsNextToTheBorder) {
  const Eigen::Vector2d place(6.0, 120.0);
  memory_.keep(seen(picture_), place, 7);
  Eigen::Matrix3d g = Eigen::Matrix3d::Identity();
  g.topRightCorner<2, 1>() << 3.0, 1.0;
  Eigen::Vector2d found = place;
  ASSERT_TRUE(flow_.follow(memory_, seen(test::view(picture_, g, 1.0, 0.0, 1.0, 7)), 0, found));
  EXPECT_LT((found - place - Eigen::Vector2d(3.0, 1.0)).norm(), 0.3);
}

}  // namespace
}  // namespace laparoscope_servo::features
