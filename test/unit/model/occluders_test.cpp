// Faces and cylinders hide what is behind them, and neither themselves nor what touches them.
#include "model/occluders.h"

#include <gtest/gtest.h>

#include "model/strands.h"
#include "support/synthetic_model.h"

namespace laparoscope_servo::model {
namespace {

// A square of 2 m by 2 m across the view, seen from its front at a depth of 4 m; behind it nothing but points.
class OccludersTest : public ::testing::Test {
 protected:
  void SetUp() override {
    model_ = test::modelOf("V1\n4\n-1 -1 4\n-1 1 4\n1 1 4\n1 -1 4\n0\n0\n1\n4 0 1 2 3\n0\n0\n");
    occluders_.reserve(*model_);
    occluders_.set(*model_, Eigen::Isometry3d::Identity(), {1});
  }
  std::shared_ptr<const CadModel> model_;
  Occluders occluders_;
};

TEST_F(OccludersTest, aFaceHidesWhatIsBehindItOnly) {
  EXPECT_TRUE(occluders_.hides({0.0, 0.0, 5.0}, 0.0));
  EXPECT_FALSE(occluders_.hides({0.0, 0.0, 3.0}, 0.0));
  EXPECT_FALSE(occluders_.hides({0.5, 0.5, 4.0}, 0.0));  // in its plane
  EXPECT_TRUE(occluders_.hides({1.2, 0.0, 5.0}, 0.0));   // seen at 0.24; the face ends at 0.25
  EXPECT_FALSE(occluders_.hides({1.3, 0.0, 5.0}, 0.0));
}

TEST_F(OccludersTest, theMarginReachesBeyondItsOutline) {
  EXPECT_TRUE(occluders_.hides({1.3, 0.0, 5.0}, 0.011));
  EXPECT_FALSE(occluders_.hides({1.3, 0.0, 5.0}, 0.009));
  EXPECT_FALSE(occluders_.hides({1.3, 0.0, 3.0}, 0.3));  // in front: beside it or not
}

TEST_F(OccludersTest, aFaceThatPointsAwayHidesNothing) {
  occluders_.set(*model_, Eigen::Isometry3d::Identity(), {0});
  EXPECT_FALSE(occluders_.hides({0.0, 0.0, 5.0}, 0.0));
}

TEST(OccludersOfTubes, aCylinderHidesWhatIsBehindItAndNotItsOwnSides) {
  const auto model = test::modelOf("V1\n2\n0 -1 4\n0 1 4\n0\n0\n0\n1\n0 1 0.5\n0\n");
  Occluders occluders;
  occluders.reserve(*model);
  const Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  occluders.set(*model, pose, {});
  EXPECT_TRUE(occluders.hides({0.0, 0.0, 5.0}, 0.0));
  EXPECT_TRUE(occluders.hides({0.0, 0.9, 4.4}, 0.0));    // inside
  EXPECT_FALSE(occluders.hides({0.0, 0.0, 3.0}, 0.0));   // before it
  EXPECT_FALSE(occluders.hides({0.0, 1.6, 5.0}, 0.0));   // passes below its end
  EXPECT_FALSE(occluders.hides({0.65, 0.0, 5.0}, 0.0));  // beside it
  EXPECT_TRUE(occluders.hides({0.65, 0.0, 5.0}, 0.01));
  for (int side = 0; side < 2; ++side) {
    const Segment line = sideSegment(model->cylinders[0], pose, side);
    for (const double along : {0.05, 0.5, 0.95}) EXPECT_FALSE(occluders.hides(line.at(along), 0.01)) << along;
  }
}

TEST(OccludersOfTubes, theFarHalfOfACircleAtItsEndIsHiddenFromTheSide) {
  // The tube's upper circle, seen from a little below it.
  const auto model = test::modelOf("V1\n4\n0 0 0\n0 0 1\n1 0 1\n0 1 1\n0\n0\n0\n1\n0 1 0.2\n1\n0.2 1 2 3\n");
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() << 1, 0, 0, 0, 0, -1, 0, 1, 0;  // the tube's axis is up, the camera at its middle's height
  pose.translation() = Eigen::Vector3d(0.0, 0.5, 3.0);
  Occluders occluders;
  occluders.reserve(*model);
  occluders.set(*model, pose, {});
  int hidden = 0;
  for (int k = 0; k < 64; ++k) {
    const Eigen::Vector3d point = circlePoint(model->circles[0], pose, 2.0 * M_PI * (k + 0.5) / 64).point;
    const bool is_hidden = occluders.hides(point, 0.0);
    if (point.z() > 3.05 || point.z() < 2.95) {
      EXPECT_EQ(is_hidden, point.z() > 3.0) << k;
    }
    hidden += is_hidden ? 1 : 0;
  }
  EXPECT_NEAR(hidden, 32, 5);
}

}  // namespace
}  // namespace laparoscope_servo::model
