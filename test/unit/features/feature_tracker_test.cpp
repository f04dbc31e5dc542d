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
#include "laparoscope_servo/features/ellipse.h"
#include "laparoscope_servo/features/line.h"
#include "laparoscope_servo/features/point_feature_tracker.h"
#include "support/synthetic_edges.h"

namespace laparoscope_servo::features {
namespace {

constexpr double kPeriod = 0.04;                               // s
const Eigen::Vector2d kDisc(90.0, 120.0), kSmall(90.0, 50.0);  // px
constexpr double kLine = 220.0;                                // px, x of the line

// A disc, a smaller one, and the border of a half plane, `shift` px to the right.
cv::Mat scene(double shift, const std::function<void(cv::Mat1f&)>& cover = nullptr) {
  const Eigen::Vector2d by(shift, 0.0);
  const test::Region disc = test::ellipse(kDisc + by, 25.0, 22.0, 0.3),
                     small = test::ellipse(kSmall + by, 9.0, 9.0, 0.0), half = test::halfPlane(kLine + shift, 0.0);
  test::EdgeScene drawn;
  drawn.seed = static_cast<unsigned>(shift) + 1;
  return test::draw(
      drawn, [&](const Eigen::Vector2d& p) { return disc(p) || small(p) || half(p); }, cover);
}

cv::Mat covered() {
  return scene(1.0, [](cv::Mat1f& pixels) { pixels.setTo(100.0f); });
}

FeatureSelection dots() {
  FeatureSelection selection(2);
  selection[0].id = "large";
  selection[0].points = {kDisc};
  selection[1].id = "small";
  selection[1].points = {kSmall};
  selection[1].desired = Eigen::Vector2d(100.0, 60.0);
  return selection;
}

// Two places on the outline of the small disc, whose windows hold it in part.
FeatureSelection points() {
  FeatureSelection selection(2);
  selection[0].id = "middle";
  selection[0].points = {kSmall};
  selection[1].id = "beside";
  selection[1].points = {kSmall + Eigen::Vector2d(6.0, -4.0)};
  return selection;
}

FeatureSelection edges() {
  FeatureSelection selection(2);
  selection[0].id = "border";
  selection[0].kind = FeatureKind::kLine;
  selection[0].points = {{kLine + 1.0, 30.0}, {kLine - 1.0, 200.0}};
  selection[1].id = "rim";
  selection[1].kind = FeatureKind::kEllipse;
  selection[1].ellipse = EllipseSelection{kDisc, 26.0, 22.0, 0.3};
  return selection;
}

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

TEST(FeatureTracker, tellsDotsByTheirIds) {
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

TEST(FeatureTracker, tellsALineAndAnEllipseOfOneImage) {
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
  const Ellipse truth(kDisc + Eigen::Vector2d(2.0, 0.0), 25.0, 22.0, 0.3);
  EXPECT_LT((Ellipse::fromCoefficients(rim.parameters).centre() - truth.centre()).norm(), 0.15);
  EXPECT_EQ(rim.covariance.rows(), 5);
  for (const Eigen::Vector2d& point : rim.outline) {
    const double radius = (point - truth.centre()).norm();
    EXPECT_GT(radius, 21.5);
    EXPECT_LT(radius, 25.5);
  }
}

TEST(FeatureTracker, tellsASpline) {
  EdgeFeatureTracker tracker;
  FeatureSelection selection(1);
  selection[0].id = "outline";
  selection[0].kind = FeatureKind::kSpline;
  selection[0].closed = true;
  const Ellipse first(kDisc, 25.0, 22.0, 0.3);
  for (int k = 0; k < 10; ++k) selection[0].points.push_back(first.at(0.2 * M_PI * k));
  tracker.select(scene(0.0), 0.0, selection, {});
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
  const Ellipse truth(kDisc + Eigen::Vector2d(2.0, 0.0), 25.0, 22.0, 0.3);
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

TEST(FeatureTracker, drawsAnArcOnly) {
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

TEST(FeatureTracker, namesTheFeatureThatIsNotThere) {
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
