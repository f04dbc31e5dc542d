#include "features/tracked_curve.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <stdexcept>

#include "laparoscope_servo/features/ellipse.h"
#include "unit/features/tracked_scene.h"

namespace laparoscope_servo::features {
namespace {

using namespace test;

SelectedFeature line() {
  return edges()[0];
}

SelectedFeature rim() {
  return edges()[1];
}

TrackedFeature told(const TrackedCurve& curve) {
  TrackedFeature feature;
  curve.tell(feature);
  return feature;
}

TEST(TrackedCurve, OnlyLinesEllipsesAndSplinesAreCurves) {
  for (const FeatureKind kind : {FeatureKind::kLine, FeatureKind::kEllipse, FeatureKind::kSpline})
    EXPECT_NE(makeTrackedCurve(kind, {}), nullptr);
  for (const FeatureKind kind :
       {FeatureKind::kPoint, FeatureKind::kPose, FeatureKind::kMotion, FeatureKind::kHomography})
    EXPECT_THROW(makeTrackedCurve(kind, {}), std::invalid_argument) << kindName(kind);
}

// As many parameters as its kind has, a covariance of them, and sites of the image.
TEST(TrackedCurve, TellsTheParametersOfItsKind) {
  struct Case {
    SelectedFeature selected;
    Eigen::Index parameters;
  };
  for (const Case& each : {Case{line(), 2}, Case{rim(), 5}, Case{contour(), 20}}) {
    const std::unique_ptr<TrackedCurve> curve = makeTrackedCurve(each.selected.kind, {});
    curve->select(scene(0.0), 0.0, each.selected);
    curve->track(scene(2.0), kPeriod, {});
    const TrackedFeature feature = told(*curve);
    EXPECT_EQ(feature.state, State::kTracking) << kindName(each.selected.kind) << ": " << feature.reason;
    EXPECT_EQ(feature.reason, "");
    EXPECT_EQ(feature.parameters.size(), each.parameters);
    EXPECT_EQ(feature.covariance.rows(), each.parameters);
    EXPECT_TRUE(feature.covariance.allFinite());
    EXPECT_GT(feature.sites.size(), 10u);
    EXPECT_GT(feature.share, 0.8);
    EXPECT_LT(feature.expected_error, 1.0);
    // Each point that is drawn lies where its kind says.
    EXPECT_GE(feature.outline.size(), 2u);
    for (const Eigen::Vector2d& p : feature.outline) {
      if (each.selected.kind == FeatureKind::kLine) {
        const double rho = feature.parameters[0], theta = feature.parameters[1];
        EXPECT_NEAR(p.x() * std::cos(theta) + p.y() * std::sin(theta), rho, 1e-9);
      } else {
        EXPECT_NEAR((p - kDisc - Eigen::Vector2d(2.0, 0.0)).norm(), 23.5, 2.0) << kindName(each.selected.kind);
      }
    }
  }
}

// Where it is expected is told all the same, but nothing of how well.
TEST(TrackedCurve, NothingIsKnownOfWhatIsNotSeen) {
  for (const SelectedFeature& selected : {line(), rim(), contour()}) {
    const std::unique_ptr<TrackedCurve> curve = makeTrackedCurve(selected.kind, {});
    curve->select(scene(0.0), 0.0, selected);
    const TrackedFeature before = told(*curve);
    curve->track(covered(), kPeriod, {});
    const TrackedFeature feature = told(*curve);
    EXPECT_EQ(feature.state, State::kSearching);
    EXPECT_FALSE(feature.reason.empty());
    ASSERT_EQ(feature.covariance.rows(), feature.parameters.size());
    for (Eigen::Index k = 0; k < feature.parameters.size(); ++k) EXPECT_TRUE(std::isinf(feature.covariance(k, k)));
    ASSERT_EQ(feature.outline.size(), before.outline.size());
    for (std::size_t k = 0; k < feature.outline.size(); ++k)
      EXPECT_LT((feature.outline[k] - before.outline[k]).norm(), 1.0);
  }
}

// Five points on it, or centre, radii and angle: the same ellipse.
TEST(TrackedCurve, AnEllipseIsGivenByPointsOrByItsForm) {
  SelectedFeature by_points = rim();
  by_points.ellipse.reset();
  for (const double phi : {0.1, 1.2, 2.6, 3.9, 5.4}) by_points.points.push_back(discOutline().at(phi));
  const auto first = makeTrackedCurve(FeatureKind::kEllipse, {}), second = makeTrackedCurve(FeatureKind::kEllipse, {});
  first->select(scene(0.0), 0.0, rim());
  second->select(scene(0.0), 0.0, by_points);
  EXPECT_LT((Ellipse::fromCoefficients(told(*first).parameters).centre() -
             Ellipse::fromCoefficients(told(*second).parameters).centre())
                .norm(),
            0.1);
}

TEST(TrackedCurve, RefusesWhatIsNotThere) {
  const std::unique_ptr<TrackedCurve> curve = makeTrackedCurve(FeatureKind::kLine, {});
  SelectedFeature nowhere = line();
  nowhere.points = {{20.0, 20.0}, {20.0, 200.0}};
  EXPECT_THROW(curve->select(scene(0.0), 0.0, nowhere), std::invalid_argument);
  nowhere.points = {{20.0, 20.0}, {20.0, 25.0}};
  EXPECT_THROW(curve->select(scene(0.0), 0.0, nowhere), std::invalid_argument) << "too short for a line";
  EXPECT_EQ(told(*curve).state, State::kIdle);
}

}  // namespace
}  // namespace laparoscope_servo::features
