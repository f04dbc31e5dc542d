// What lines, ellipses and splines tell behind the interface of all trackers; what holds for all of them:
// feature_tracker_test.cpp.
#include "laparoscope_servo/features/edge_feature_tracker.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <string>

#include "laparoscope_servo/features/ellipse.h"
#include "unit/features/tracked_scene.h"

namespace laparoscope_servo::features {
namespace {

using namespace test;

TEST(EdgeFeatureTracker, tellsALineAndAnEllipseOfOneImage) {
  EdgeFeatureTracker tracker;
  tracker.select(scene(0.0), 0.0, edges(), {});
  const TrackedFeatures& told = tracker.track(scene(2.0), kPeriod, {});
  EXPECT_EQ(told.state, State::kTracking) << told.reason;
  ASSERT_EQ(told.features.size(), 2u);
  const TrackedFeature& line = told.features[0];
  EXPECT_EQ(line.kind, FeatureKind::kLine);
  // The normal of a line that was drawn downwards points to the left: rho is negative there.
  EXPECT_NEAR(std::abs(line.parameters[0]), kLine + 2.0, 0.15);
  EXPECT_NEAR(std::abs(std::cos(line.parameters[1])), 1.0, 1e-3);
  EXPECT_GT(line.covariance(0, 0), 0.0);
  EXPECT_GT(line.share, 0.8);
  ASSERT_EQ(line.outline.size(), 2u);
  EXPECT_NEAR(line.outline[0].x(), kLine + 2.0, 0.2);
  const TrackedFeature& rim = told.features[1];
  EXPECT_EQ(rim.kind, FeatureKind::kEllipse);
  const Ellipse truth = discOutline(2.0);
  EXPECT_LT((Ellipse::fromCoefficients(rim.parameters).centre() - truth.centre()).norm(), 0.15);
  EXPECT_EQ(rim.covariance.rows(), 5);
  for (const Eigen::Vector2d& point : rim.outline) {
    const double radius = (point - truth.centre()).norm();
    EXPECT_GT(radius, 21.5);
    EXPECT_LT(radius, 25.5);
  }
}

TEST(EdgeFeatureTracker, tellsASpline) {
  EdgeFeatureTracker tracker;
  tracker.select(scene(0.0), 0.0, {contour()}, {});
  const TrackedFeatures& told = tracker.track(scene(2.0), kPeriod, {});
  ASSERT_EQ(told.state, State::kTracking) << told.reason;
  const TrackedFeature& spline = told.features[0];
  EXPECT_EQ(spline.kind, FeatureKind::kSpline);
  EXPECT_EQ(spline.parameters.size(), 20);
  ASSERT_EQ(spline.covariance.rows(), 20);
  // Across the curve a control point is known, along it there is nothing to be known.
  const Eigen::Matrix2d of_first = spline.covariance.topLeftCorner<2, 2>();
  EXPECT_GT(of_first.trace(), 0.0);
  EXPECT_NEAR(of_first.determinant(), 0.0, 1e-9);
  const Ellipse truth = discOutline(2.0);
  const EllipseCoefficients c = truth.coefficients();
  for (const Eigen::Vector2d& p : spline.outline) {
    const double value =
        p.x() * p.x() + c[0] * p.y() * p.y() + 2.0 * (c[1] * p.x() * p.y() + c[2] * p.x() + c[3] * p.y()) + c[4];
    EXPECT_NEAR(value / 50.0, 0.0, 0.5);  // the equation grows by about 2 x 25 a px
  }
  // One that is covered is not known at all.
  tracker.track(covered(), 2.0 * kPeriod, {});
  EXPECT_EQ(spline.state, State::kSearching);
  EXPECT_TRUE(std::isinf(spline.covariance(3, 3)));
}

TEST(EdgeFeatureTracker, drawsAnArcOnly) {
  EdgeFeatureTracker tracker;
  FeatureSelection selection(1, edges()[1]);
  selection[0].arc = ArcSelection{0.0, M_PI};
  const TrackedFeatures& told = tracker.select(scene(0.0), 0.0, selection, {});
  double span = 0.0;
  for (const Eigen::Vector2d& point : told.features[0].outline)
    span = std::max(span, (point - told.features[0].outline.front()).norm());
  // From one end of a half ellipse to the other; nothing of it lies on the other side.
  EXPECT_NEAR((told.features[0].outline.back() - told.features[0].outline.front()).norm(), span, 2.0);
}

TEST(EdgeFeatureTracker, namesTheFeatureThatIsNotThere) {
  EdgeFeatureTracker tracker;
  FeatureSelection selection = edges();
  selection[0].points = {{20.0, 20.0}, {20.0, 25.0}};
  try {
    tracker.select(scene(0.0), 0.0, selection, {});
    FAIL() << "a line of 5 px was selected";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("border: line from (20, 20) to (20, 25)"), std::string::npos)
        << error.what();
  }
}

// One that is lost does not take the others along.
TEST(EdgeFeatureTracker, TracksEachByItself) {
  EdgeFeatureTracker tracker;
  tracker.select(scene(0.0), 0.0, edges(), {});
  const auto cover = [](cv::Mat1f& pixels) { pixels.colRange(150, pixels.cols).setTo(100.0f); };
  const TrackedFeatures& told = tracker.track(scene(1.0, cover), kPeriod, {});
  EXPECT_EQ(told.features[0].state, State::kSearching);
  EXPECT_EQ(told.features[1].state, State::kTracking) << told.features[1].reason;
  EXPECT_EQ(told.state, State::kSearching) << "the worst of them";
}

TEST(EdgeFeatureTracker, RefusesAConfigurationWithEveryError) {
  EdgeConfig config;
  config.spacing = 0.0;
  config.max_error = -1.0;
  try {
    EdgeFeatureTracker tracker(config);
    FAIL() << "a spacing of 0 px was accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("spacing = 0"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("max_error = -1"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace laparoscope_servo::features
