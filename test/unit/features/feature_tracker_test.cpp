// Dots and edges behind the interface of all trackers: what is told is what the trackers themselves find.
#include "laparoscope_servo/features/feature_tracker.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <stdexcept>

#include "laparoscope_servo/features/dot_feature_tracker.h"
#include "laparoscope_servo/features/edge_feature_tracker.h"
#include "laparoscope_servo/features/point_feature_tracker.h"
#include "unit/features/tracked_scene.h"

namespace laparoscope_servo::features {
namespace {

using namespace test;

struct Case {
  const char* name;
  FeatureSelection selection;
  std::function<std::unique_ptr<FeatureTracker>()> make;
};

std::vector<Case> cases() {
  return {{"dots", dots(), [] { return std::make_unique<DotFeatureTracker>(); }},
          {"points", points(), [] { return std::make_unique<PointFeatureTracker>(); }},
          {"edges", edges(), [] { return std::make_unique<EdgeFeatureTracker>(); }}};
}

TEST(FeatureTracker, tellsTheWorstStateAndWhose) {
  for (const Case& each : cases()) {
    const auto tracker = each.make();
    EXPECT_EQ(tracker->features().state, State::kIdle) << each.name;
    EXPECT_EQ(tracker->features().reason, "nothing is selected") << each.name;
    tracker->select(scene(0.0), 0.0, each.selection, {});
    const TrackedFeatures& told = tracker->track(covered(), kPeriod, {});
    EXPECT_EQ(told.state, State::kSearching) << each.name;
    EXPECT_EQ(told.reason, each.selection[0].id + ": " + told.features[0].reason) << each.name;
    EXPECT_FALSE(told.features[0].reason.empty()) << each.name;
    EXPECT_TRUE(std::isinf(told.features[0].expected_error)) << each.name;
    EXPECT_TRUE(std::isinf(told.features[0].covariance(0, 0))) << each.name;
    EXPECT_EQ(told.features[0].covariance(0, 1), 0.0) << each.name;
    EXPECT_EQ(tracker->track(covered(), 10.0, {}).state, State::kLost) << each.name;
  }
}

TEST(FeatureTracker, endsWithTheReasonWhereTheImagesEnd) {
  for (const Case& each : cases()) {
    const auto tracker = each.make();
    tracker->select(scene(0.0), 1.0, each.selection, {});
    EXPECT_EQ(tracker->track(scene(0.0), 0.5, {}).state, State::kIdle) << each.name;
    EXPECT_EQ(tracker->features().reason, "the stamp lies before the last one") << each.name;
    EXPECT_TRUE(tracker->features().features.empty()) << each.name;
    tracker->select(scene(0.0), 1.0, each.selection, {});
    const cv::Mat colour(240, 320, CV_8UC3, cv::Scalar::all(90));
    EXPECT_EQ(tracker->track(colour, 1.1, {}).state, State::kIdle) << each.name;
    EXPECT_NE(tracker->features().reason.find("another size or type"), std::string::npos) << each.name;
    // The reason stays, image after image.
    EXPECT_NE(tracker->track(colour, 1.2, {}).reason.find("another size or type"), std::string::npos) << each.name;
    tracker->select(scene(0.0), 2.0, each.selection, {});
    tracker->reset();
    EXPECT_EQ(tracker->features().state, State::kIdle) << each.name;
    EXPECT_EQ(tracker->features().reason, "reset") << each.name;
    EXPECT_TRUE(tracker->features().features.empty()) << each.name;
    const auto fresh = each.make();
    fresh->reset();
    EXPECT_EQ(fresh->features().reason, "reset") << each.name;
  }
}

TEST(FeatureTracker, goesOnWhereASelectionIsRefused) {
  for (const Case& each : cases()) {
    const auto tracker = each.make();
    tracker->select(scene(0.0), 0.0, each.selection, {});
    FeatureSelection off = each.selection;
    off[1].id = "off";
    off[1].points = {{1000.0, 50.0}};
    if (off[1].kind == FeatureKind::kEllipse) {
      off[1].points.clear();
      off[1].ellipse->centre.x() = 1000.0;
    }
    FeatureSelection other_kind = each.selection;
    other_kind[0].kind = FeatureKind::kPose;
    for (const FeatureSelection& bad : {off, other_kind, FeatureSelection()}) {
      EXPECT_THROW(tracker->select(scene(0.0), 0.02, bad, {}), std::invalid_argument) << each.name;
    }
    EXPECT_EQ(tracker->track(scene(1.0), kPeriod, {}).state, State::kTracking) << each.name;
    EXPECT_EQ(tracker->features().features[1].id, each.selection[1].id) << each.name;
  }
}

// A jump of the picture that is known beforehand is followed, and is not without.
TEST(FeatureTracker, followsTheMotionThatIsKnown) {
  constexpr double kJump = 45.0;  // px
  FeaturePrior prior;
  prior.motion = Eigen::Matrix3d::Identity();
  (*prior.motion)(0, 2) = kJump;
  for (const Case& each : cases()) {
    for (const bool known : {true, false}) {
      const auto tracker = each.make();
      tracker->select(scene(0.0), 0.0, each.selection, {});
      const State state = tracker->track(scene(kJump), kPeriod, known ? prior : FeaturePrior()).state;
      EXPECT_EQ(state, known ? State::kTracking : State::kSearching) << each.name << known;
    }
  }
}

// A motion that is none is ignored; one that leads out of the image loses the features, without a number that is not
// finite for a place.
TEST(FeatureTracker, bearsAnyMotionThatIsTold) {
  const double infinite = std::numeric_limits<double>::infinity();
  for (const Case& each : cases()) {
    for (const double wrong : {std::nan(""), infinite, -infinite, 0.0}) {
      const auto tracker = each.make();
      tracker->select(scene(0.0), 0.0, each.selection, {});
      FeaturePrior prior;
      prior.motion = Eigen::Matrix3d::Constant(wrong);
      EXPECT_EQ(tracker->track(scene(0.0), kPeriod, prior).state, State::kTracking) << each.name << ' ' << wrong;
      (*prior.motion) = Eigen::Matrix3d::Identity();
      (*prior.motion)(0, 2) = wrong;
      EXPECT_EQ(tracker->track(scene(0.0), 2.0 * kPeriod, prior).state, State::kTracking) << each.name << ' ' << wrong;
    }
    for (const double far : {1e5, 1e9, 1e200}) {
      const auto tracker = each.make();
      tracker->select(scene(0.0), 0.0, each.selection, {});
      FeaturePrior prior;
      prior.motion = Eigen::Matrix3d::Identity();
      prior.motion->topLeftCorner<2, 2>() *= far;
      for (const TrackedFeature& feature : tracker->track(scene(0.0), kPeriod, prior).features) {
        EXPECT_TRUE(feature.parameters.allFinite()) << each.name << ' ' << far;
        EXPECT_FALSE(std::isnan(feature.expected_error)) << each.name << ' ' << far;
        EXPECT_FALSE(feature.covariance.hasNaN()) << each.name << ' ' << far;
      }
    }
  }
}

}  // namespace
}  // namespace laparoscope_servo::features
