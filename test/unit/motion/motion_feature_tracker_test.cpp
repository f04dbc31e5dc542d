#include "laparoscope_servo/motion/motion_feature_tracker.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "support/error_text.h"
#include "support/synthetic_motion.h"

namespace laparoscope_servo::motion {
namespace {

using features::FeatureKind;
using features::FeatureSelection;
using features::State;
using features::TrackedFeatures;
using test::movingTissue;
using test::usualMotion;

FeatureSelection selectionOf(const std::string& id, const std::vector<Eigen::Vector2d>& points = {}) {
  FeatureSelection selection(1);
  selection[0].id = id;
  selection[0].kind = FeatureKind::kMotion;
  selection[0].points = points;
  return selection;
}

std::string refusal(MotionFeatureTracker& tracker, const FeatureSelection& selection) {
  return test_support::errorText<std::invalid_argument>(
      [&] { tracker.select(movingTissue(0, usualMotion()), 0.0, selection, {}); });
}

TEST(MotionFeatureTracker, TellsTheFieldWithoutASelection) {
  MotionFeatureTracker tracker;
  EXPECT_TRUE(tracker.findsByItself());
  EXPECT_TRUE(tracker.takesSelection());
  EXPECT_EQ(tracker.features().state, State::kIdle);
  const MotionField field = usualMotion();
  const TrackedFeatures& first = tracker.track(movingTissue(0, field), 0.0, {});
  EXPECT_EQ(first.state, State::kIdle);
  EXPECT_NE(first.reason.find("second image"), std::string::npos) << first.reason;
  const TrackedFeatures& told = tracker.track(movingTissue(1, field), 0.04, {});
  ASSERT_EQ(told.state, State::kTracking) << told.reason;
  ASSERT_EQ(told.features.size(), 1u);
  const features::TrackedFeature& motion = told.features[0];
  EXPECT_EQ(motion.id, "motion");
  EXPECT_EQ(motion.kind, FeatureKind::kMotion);
  ASSERT_EQ(motion.parameters.size(), 8);
  EXPECT_NEAR(motion.parameters[0], field.a[0], 0.05);
  EXPECT_NEAR(motion.parameters[2], field.a[2], 0.001);
  ASSERT_EQ(motion.covariance.rows(), 8);
  EXPECT_GT(motion.covariance(0, 0), 0.0);
  EXPECT_EQ(motion.outline.size(), 5u);
  EXPECT_GT(motion.share, 0.9);
  EXPECT_LT(motion.expected_error, 0.1);
}

TEST(MotionFeatureTracker, HasAsManyParametersAsItsModel) {
  MotionConfig config;
  config.model = Model::kAffine;
  MotionFeatureTracker tracker(config);
  for (int k = 0; k < 2; ++k) tracker.track(movingTissue(k, usualMotion(Model::kAffine)), 0.04 * k, {});
  EXPECT_EQ(tracker.features().features[0].parameters.size(), 6);
  EXPECT_EQ(tracker.features().features[0].covariance.rows(), 6);
}

TEST(MotionFeatureTracker, ARegionIsSelectedByTwoCorners) {
  MotionFeatureTracker tracker;
  const MotionField field = usualMotion();
  FeatureSelection selection = selectionOf("liver", {{250.0, 200.0}, {60.0, 40.0}});
  selection[0].desired = Eigen::VectorXd::Zero(8);
  EXPECT_EQ(tracker.select(movingTissue(0, field), 0.0, selection, {}).features[0].id, "liver");
  const TrackedFeatures& told = tracker.track(movingTissue(1, field), 0.04, {});
  ASSERT_EQ(told.state, State::kTracking) << told.reason;
  EXPECT_EQ(told.features[0].desired.size(), 8);
  const Eigen::Vector2d corner(60.0, 40.0);
  EXPECT_LT((told.features[0].outline[0] - geometry::apply(homographyOf(field), corner)).norm(), 0.2);
}

// The first image stays the reference: what is told of it does not drift.
TEST(MotionFeatureTracker, AnImageIsSelectedWithoutPoints) {
  MotionFeatureTracker tracker;
  MotionField field = usualMotion();
  field.a *= 0.3;
  EXPECT_EQ(tracker.select(movingTissue(0, field), 0.0, selectionOf("view"), {}).features[0].state, State::kTracking);
  for (int k = 1; k < 8; ++k) {
    const TrackedFeatures& told = tracker.track(movingTissue(k, field), 0.04 * k, {});
    ASSERT_EQ(told.state, State::kTracking) << told.reason;
    ASSERT_EQ(told.features.size(), 2u);
    EXPECT_EQ(told.features[0].id, "view");
    EXPECT_EQ(told.features[1].id, "view step");
    EXPECT_NEAR(told.features[0].parameters[0], k * field.a[0], 0.05);
    EXPECT_NEAR(told.features[1].parameters[0], field.a[0], 0.05);
  }
  // Another sequence: it is told without the selection.
  const TrackedFeatures& told = tracker.track(movingTissue(1, field), 0.0, {});
  EXPECT_EQ(told.state, State::kIdle);
  ASSERT_EQ(told.features.size(), 1u);
  EXPECT_EQ(told.features[0].id, "motion");
  EXPECT_NE(told.reason.find("before the last one"), std::string::npos) << told.reason;
  EXPECT_EQ(tracker.track(movingTissue(2, field), 0.04, {}).state, State::kTracking);
}

TEST(MotionFeatureTracker, RefusesAWrongSelectionAndGoesOn) {
  MotionFeatureTracker tracker;
  const MotionField field = usualMotion();
  for (int k = 0; k < 2; ++k) tracker.track(movingTissue(k, field), 0.04 * k, {});
  FeatureSelection point = selectionOf("dot", {{1.0, 2.0}});
  point[0].kind = FeatureKind::kPoint;
  EXPECT_NE(refusal(tracker, point).find("expected motion of this tracker"), std::string::npos);
  EXPECT_NE(refusal(tracker, selectionOf("one", {{1.0, 2.0}})).find("0, or 2: opposite corners"), std::string::npos);
  EXPECT_NE(refusal(tracker, selectionOf("small", {{1.0, 2.0}, {9.0, 9.0}})).find("small: region of 9 x 8 px"),
            std::string::npos);
  EXPECT_NE(refusal(tracker, {}).find("0 features, expected 1"), std::string::npos);
  FeatureSelection desired = selectionOf("far");
  desired[0].desired = Eigen::VectorXd::Zero(6);
  EXPECT_NE(refusal(tracker, desired).find("expected one for each of the 8"), std::string::npos);
  const TrackedFeatures& told = tracker.track(movingTissue(2, field), 0.08, {});
  EXPECT_EQ(told.state, State::kTracking);
  EXPECT_EQ(told.features[0].id, "motion");
}

TEST(MotionFeatureTracker, ItsMaskIsWhatDoesNotFollow) {
  MotionFeatureTracker tracker;
  EXPECT_TRUE(tracker.givesMask());
  EXPECT_TRUE(tracker.mask().empty());
  const MotionField field = usualMotion();
  for (int k = 0; k < 3; ++k) {
    cv::Mat image = movingTissue(k, field);
    test::cover(image, k, cv::Rect(32, 32, 128, 128), {-3.0, 4.0});
    tracker.track(image, 0.04 * k, {});
  }
  const cv::Mat mask = tracker.mask();
  ASSERT_EQ(mask.size(), cv::Size(320, 240));
  ASSERT_EQ(mask.type(), CV_8UC1);
  EXPECT_EQ(mask.at<unsigned char>(100, 90), 255);
  EXPECT_EQ(mask.at<unsigned char>(100, 260), 0);
}

TEST(MotionFeatureTracker, TakesAMaskWithTheImage) {
  MotionFeatureTracker tracker;
  const MotionField field = usualMotion();
  features::FeaturePrior prior;
  prior.mask = cv::Mat(240, 320, CV_8UC1, cv::Scalar(255));
  for (int k = 0; k < 2; ++k) tracker.track(movingTissue(k, field), 0.04 * k, prior);
  EXPECT_EQ(tracker.features().state, State::kSearching);
  EXPECT_NE(tracker.features().reason.find("masked"), std::string::npos) << tracker.features().reason;
}

TEST(MotionFeatureTracker, IsUncertainUnlessItTracks) {
  MotionFeatureTracker tracker;
  for (int k = 0; k < 2; ++k) tracker.track(cv::Mat(240, 320, CV_8UC3, cv::Scalar::all(0)), 0.04 * k, {});
  const features::TrackedFeature& motion = tracker.features().features[0];
  EXPECT_EQ(motion.state, State::kSearching);
  EXPECT_TRUE(std::isinf(motion.covariance(7, 7)));
  EXPECT_TRUE(std::isinf(motion.expected_error));
  tracker.reset();
  EXPECT_EQ(tracker.features().state, State::kIdle);
  EXPECT_TRUE(tracker.features().features.empty());
}

}  // namespace
}  // namespace laparoscope_servo::motion
