#include "laparoscope_servo/features/point_feature_tracker.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "support/synthetic_edges.h"
#include "support/synthetic_tissue.h"

namespace laparoscope_servo::features {
namespace {

constexpr double kPeriod = 0.04;           // s
const Eigen::Vector2d kSmall(90.0, 50.0);  // px

// A small disc, `shift` px to the right.
cv::Mat scene(double shift) {
  test::EdgeScene drawn;
  drawn.seed = static_cast<unsigned>(shift) + 1;
  return test::draw(drawn, test::ellipse(kSmall + Eigen::Vector2d(shift, 0.0), 9.0, 9.0, 0.0));
}

// In its middle, and a place whose window holds it in part.
FeatureSelection points() {
  FeatureSelection selection(2);
  selection[0].id = "middle";
  selection[0].points = {kSmall};
  selection[1].id = "beside";
  selection[1].points = {kSmall + Eigen::Vector2d(6.0, -4.0)};
  return selection;
}

TEST(PointFeatureTracker, tellsPointsByTheirIds) {
  PointFeatureTracker tracker;
  FeatureSelection selection = points();
  selection[1].desired = Eigen::Vector2d(100.0, 60.0);
  tracker.select(scene(0.0), 0.0, selection, {});
  const TrackedFeatures& told = tracker.track(scene(3.0), kPeriod, {});
  EXPECT_EQ(told.state, State::kTracking) << told.reason;
  ASSERT_EQ(told.features.size(), 2u);
  const TrackedFeature& middle = told.features[0];
  EXPECT_EQ(middle.id, "middle");
  EXPECT_EQ(middle.kind, FeatureKind::kPoint);
  EXPECT_LT((middle.parameters - (kSmall + Eigen::Vector2d(3.0, 0.0))).norm(), 0.15);
  EXPECT_NEAR(middle.expected_error, std::sqrt(middle.covariance.diagonal().maxCoeff()), 0.02);
  EXPECT_GT(middle.share, 0.8);
  ASSERT_EQ(middle.outline.size(), 5u);  // the window, back to where it begins
  EXPECT_EQ(middle.outline.front(), middle.outline.back());
  EXPECT_NEAR((middle.outline[0] - middle.outline[2]).norm(), 21.0 * std::sqrt(2.0), 1.0);
  EXPECT_EQ(told.features[1].desired, Eigen::Vector2d(100.0, 60.0));
}

TEST(PointFeatureTracker, numbersTheCornersThatItChooses) {
  PointFeatureTracker tracker;
  FeatureSelection selection = points();
  selection[0].points.clear();
  selection[0].corners = CornerSelection{{60, 20, 60, 60}, 4};
  const TrackedFeatures& told = tracker.select(scene(0.0), 0.0, selection, {});
  ASSERT_GE(told.features.size(), 2u);
  EXPECT_EQ(told.features[0].id, "middle 1");
  EXPECT_EQ(told.features.back().id, "beside");
  EXPECT_TRUE(told.features[0].desired.size() == 0);
  // A number that another feature has.
  selection[1].id = "middle 1";
  EXPECT_THROW(tracker.select(scene(0.0), 0.0, selection, {}), std::invalid_argument);
  selection[0].corners->region = {150, 10, 30, 30};  // where nothing is
  EXPECT_THROW(tracker.select(scene(0.0), 0.0, selection, {}), std::invalid_argument);
}

// What is desired of a point in a stored picture is that it be seen where it is there.
TEST(PointFeatureTracker, wantsPointsWhereTheStoredPictureHasThem) {
  const cv::Mat stored = test::tissue({320, 240}, 6);
  FeatureSelection selection(1);
  selection[0].id = "liver";
  selection[0].corners = CornerSelection{{80, 60, 160, 120}, 15};
  selection[0].picture = stored;
  Eigen::Matrix3d g = Eigen::Matrix3d::Identity();
  g.topRightCorner<2, 1>() << 14.0, -9.0;
  PointFeatureTracker tracker;
  const TrackedFeatures& told = tracker.select(test::view(stored, g, 1.0, 0.0, 1.0), 0.0, selection, {});
  ASSERT_GE(told.features.size(), 10u);
  for (const TrackedFeature& feature : told.features) {
    ASSERT_EQ(feature.desired.size(), 2);
    if (feature.state == State::kTracking) {
      EXPECT_LT((feature.parameters - feature.desired - Eigen::Vector2d(14.0, -9.0)).norm(), 0.2);
    }
  }
}

}  // namespace
}  // namespace laparoscope_servo::features
