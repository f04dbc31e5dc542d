#include "laparoscope_servo/features/feature_selection.h"

#include <gtest/gtest.h>

#include <limits>

namespace laparoscope_servo::features {
namespace {

SelectedFeature point(const std::string& id) {
  SelectedFeature feature;
  feature.id = id;
  feature.points = {{10.0, 20.0}};
  return feature;
}

SelectedFeature line() {
  SelectedFeature feature;
  feature.id = "shaft";
  feature.kind = FeatureKind::kLine;
  feature.points = {{10.0, 20.0}, {90.0, 60.0}};
  return feature;
}

SelectedFeature ellipse() {
  SelectedFeature feature;
  feature.id = "rim";
  feature.kind = FeatureKind::kEllipse;
  feature.ellipse = EllipseSelection{{100.0, 80.0}, 40.0, 30.0, 0.2};
  return feature;
}

const std::vector<FeatureKind> kAll = {FeatureKind::kPoint, FeatureKind::kLine, FeatureKind::kEllipse,
                                       FeatureKind::kSpline};

// That there is this one error and no other.
void expectError(const SelectedFeature& feature, const std::string& error) {
  const std::vector<std::string> errors = validate({feature}, kAll);
  ASSERT_EQ(errors.size(), 1u) << error;
  EXPECT_EQ(errors.front(), error);
}

// Of the tracker of points.
void expectPointError(const SelectedFeature& feature, const std::string& error) {
  const std::vector<std::string> errors = validate({feature}, kAll, true);
  ASSERT_EQ(errors.size(), 1u) << error;
  EXPECT_EQ(errors.front(), error);
}

TEST(FeatureSelection, takesWhatIsWhole) {
  SelectedFeature arc = ellipse();
  arc.id = "arc";
  arc.arc = ArcSelection{0.5, 1.5};
  arc.desired = Eigen::VectorXd::Ones(5);
  SelectedFeature through = ellipse();
  through.id = "through";
  through.ellipse.reset();
  through.points.assign(5, {1.0, 2.0});
  EXPECT_TRUE(validate({point("a"), point("b"), line(), ellipse(), arc, through}, kAll).empty());
  EXPECT_TRUE(validate({}, kAll).empty());
}

TEST(FeatureSelection, aMotionHasARegionOrNone) {
  SelectedFeature motion = line();
  motion.kind = FeatureKind::kMotion;
  EXPECT_TRUE(validate({motion}, {FeatureKind::kMotion}).empty());
  motion.points.clear();
  EXPECT_TRUE(validate({motion}, {FeatureKind::kMotion}).empty());
  motion.points = {{1.0, 2.0}};
  EXPECT_EQ(validate({motion}, {FeatureKind::kMotion}).front(),
            "shaft: number of points = 1, expected 0, or 2: opposite corners of a region");
}

TEST(FeatureSelection, whatIsToldBeginsWithIdsKindsAndDesiredValues) {
  SelectedFeature point, pose;
  point.id = "dot";
  point.desired = Eigen::Vector2d(3.0, 4.0);
  pose.id = "clamp";
  pose.kind = FeatureKind::kPose;
  TrackedFeatures told;
  told.features.resize(3);
  told.features[0].reason = "of the one before";
  begin(told, {point, pose});
  ASSERT_EQ(told.features.size(), 2u);
  EXPECT_EQ(told.features[0].id, "dot");
  EXPECT_EQ(told.features[0].desired, point.desired);
  EXPECT_EQ(told.features[0].reason, "");
  EXPECT_EQ(told.features[1].id, "clamp");
  EXPECT_EQ(told.features[1].kind, FeatureKind::kPose);
}

TEST(FeatureSelection, refusesIdsThatTellNothing) {
  std::vector<std::string> errors = validate({point("a"), point("a")}, kAll);
  ASSERT_EQ(errors.size(), 1u);
  EXPECT_EQ(errors.front(), "a: id = a, expected an id that no other feature has");
  errors = validate({point("a"), point("")}, kAll);
  ASSERT_EQ(errors.size(), 1u);
  EXPECT_EQ(errors.front(), "feature 2 has no id, expected a name");
}

TEST(FeatureSelection, refusesAKindThatTheTrackerHasNot) {
  const std::vector<std::string> errors = validate({point("a")}, {FeatureKind::kLine, FeatureKind::kEllipse});
  ASSERT_EQ(errors.size(), 1u);
  EXPECT_EQ(errors.front(), "a: kind = point, expected line or ellipse of this tracker");
}

TEST(FeatureSelection, refusesEachNumberByNameValueAndExpectation) {
  SelectedFeature feature = point("a");
  feature.points.clear();
  expectError(feature, "a: number of points = 0, expected 1: where it is");
  feature.points = {{1.0, std::numeric_limits<double>::quiet_NaN()}};
  expectError(feature, "a: point = [1, nan], expected two finite numbers, px");
  feature = point("a");
  feature.corners = CornerSelection{{}, 10};
  expectPointError(feature, "a: number of points = 1, expected 0 beside corners");
  feature.points.clear();
  expectError(feature, "a: number of corners = 10, expected none: only the tracker of points chooses some");
  feature.corners->count = 0;
  expectPointError(feature, "a: number of corners = 0, expected 1 to 500");
  feature.corners->count = 10;
  feature.desired = Eigen::Vector2d(1.0, 2.0);
  expectPointError(feature, "a: number of desired values = 2, expected 0 beside corners: nobody knows them one by one");
  feature = point("a");
  feature.picture = cv::Mat(20, 30, CV_8UC1);
  expectError(feature, "a: stored picture = 30 x 20, expected none: only the tracker of points takes one");
  EXPECT_TRUE(validate({feature}, kAll, true).empty());
  feature = line();
  feature.picture = cv::Mat(20, 30, CV_8UC1);
  expectPointError(feature, "shaft: stored picture = 30 x 20, expected none: only the tracker of points takes one");
  feature = line();
  feature.points.pop_back();
  expectError(feature, "shaft: number of points = 1, expected 2: the line's ends");
  feature = line();
  feature.range = 0.0;
  expectError(feature, "shaft: range = 0, expected 1 to 100 px");
  feature.range = std::numeric_limits<double>::quiet_NaN();
  expectError(feature, "shaft: range = nan, expected 1 to 100 px");
  feature = line();
  feature.desired = Eigen::VectorXd::Zero(3);
  expectError(feature, "shaft: number of desired values = 3, expected one for each of the 2 parameters of a line");
  feature.desired = Eigen::Vector2d(0.0, std::numeric_limits<double>::infinity());
  expectError(feature, "shaft: desired value = inf, expected a finite number");
  feature = line();
  feature.arc = ArcSelection{0.0, 1.0};
  expectError(feature, "shaft: kind = line, expected ellipse beside an arc");
  feature = ellipse();
  feature.ellipse->b = 0.0;
  expectError(feature, "rim: radius = 0, expected a positive number, px");
  feature = ellipse();
  feature.points = {{1.0, 2.0}};
  expectError(feature, "rim: number of points = 1, expected 0 beside centre and radii");
  feature.ellipse.reset();
  expectError(feature, "rim: number of points = 1, expected 5 or more, or centre and radii");
}

}  // namespace
}  // namespace laparoscope_servo::features
