// What dots tell behind the interface of all trackers; what holds for all of them: feature_tracker_test.cpp.
#include "laparoscope_servo/features/dot_feature_tracker.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "unit/features/tracked_scene.h"

namespace laparoscope_servo::features {
namespace {

using namespace test;

TEST(DotFeatureTracker, tellsDotsByTheirIds) {
  DotFeatureTracker tracker;
  tracker.select(scene(0.0), 0.0, dots(), {});
  const TrackedFeatures& told = tracker.track(scene(3.0), kPeriod, {});
  EXPECT_EQ(told.state, State::kTracking) << told.reason;
  ASSERT_EQ(told.features.size(), 2u);
  EXPECT_EQ(told.features[0].id, "large");
  EXPECT_EQ(told.features[1].id, "small");
  EXPECT_EQ(told.features[0].desired.size(), 0);
  EXPECT_EQ(told.features[1].desired, Eigen::Vector2d(100.0, 60.0));
  const TrackedFeature& small = told.features[1];
  EXPECT_EQ(small.kind, FeatureKind::kPoint);
  EXPECT_LT((small.parameters - (kSmall + Eigen::Vector2d(3.0, 0.0))).norm(), 0.15);
  ASSERT_EQ(small.covariance.rows(), 2);
  EXPECT_NEAR(small.expected_error, std::sqrt(small.covariance.diagonal().maxCoeff()), 0.01);
  EXPECT_EQ(small.share, 1.0);
  for (const Eigen::Vector2d& point : small.outline)
    EXPECT_NEAR((point - kSmall - Eigen::Vector2d(3.0, 0.0)).norm(), 9.0, 0.5);
}

// The outline is a circle of the dot's area, closed, about where it is.
TEST(DotFeatureTracker, OutlinesADotByItsArea) {
  DotFeatureTracker tracker;
  const TrackedFeatures& told = tracker.select(scene(0.0), 0.0, dots(), {});
  const std::vector<Eigen::Vector2d>& outline = told.features[0].outline;
  ASSERT_GT(outline.size(), 8u);
  EXPECT_LT((outline.front() - outline.back()).norm(), 1e-9);
  double area = 0.0;
  for (std::size_t k = 1; k < outline.size(); ++k)
    area += 0.5 * (outline[k - 1].x() * outline[k].y() - outline[k].x() * outline[k - 1].y());
  EXPECT_NEAR(area, M_PI * 25.0 * 22.0, 0.03 * M_PI * 25.0 * 22.0) << "clockwise as seen in the image";
}

// What is not seen keeps its place, and has no share.
TEST(DotFeatureTracker, ADotThatIsNotSeenHasNoShare) {
  DotFeatureTracker tracker;
  tracker.select(scene(0.0), 0.0, dots(), {});
  const TrackedFeatures& told = tracker.track(covered(), kPeriod, {});
  for (const TrackedFeature& dot : told.features) {
    EXPECT_EQ(dot.state, State::kSearching);
    EXPECT_EQ(dot.share, 0.0);
    EXPECT_FALSE(dot.reason.empty());
  }
  EXPECT_LT((told.features[1].parameters - kSmall).norm(), 0.2);
}

TEST(DotFeatureTracker, TakesPointsOnly) {
  DotFeatureTracker tracker;
  EXPECT_THROW(tracker.select(scene(0.0), 0.0, edges(), {}), std::invalid_argument);
  EXPECT_TRUE(tracker.features().features.empty());
  DotsConfig config;
  config.min_radius = -1.0;
  EXPECT_THROW(DotFeatureTracker{config}, std::invalid_argument);
}

}  // namespace
}  // namespace laparoscope_servo::features
