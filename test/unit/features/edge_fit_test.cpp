#include "laparoscope_servo/features/edge_fit.h"

#include <gtest/gtest.h>

#include <cmath>

#include "laparoscope_servo/features/ellipse.h"
#include "laparoscope_servo/features/line.h"
#include "support/synthetic_edges.h"

namespace laparoscope_servo::features {
namespace {

using Cover = std::function<void(cv::Mat1f&)>;

constexpr double kRange = 8.0;   // px
constexpr double kAlways = 1e9;  // px: no jump is a surprise

// The border of a half plane at x = `at`, dark on the left; `reversed`: bright on the left.
cv::Mat border(double at, unsigned seed = 1, bool reversed = false, const Cover& cover = nullptr) {
  test::EdgeScene scene;
  scene.seed = seed;
  if (reversed) std::swap(scene.dark, scene.bright);
  return test::draw(scene, test::halfPlane(at, 0.0), cover);
}

Line lineAt(double x) {
  return {{x, 220.0}, {x, 20.0}};
}

double placeOf(const Line& line) {
  return 0.5 * (line.begin().x() + line.end().x());
}

TEST(EdgeFit, LearnsALineThatIsOff) {
  for (const double off : {-6.0, -1.0, 0.0, 3.0, 6.0}) {
    EdgeFit fit{EdgeConfig()};
    Line line = lineAt(150.0 + off);
    const EdgeReport report = fit.learn(border(150.0), line, kRange);
    ASSERT_EQ(report.reason, Reason::kNone) << off << ": " << reasonText(report.reason);
    EXPECT_NEAR(placeOf(line), 150.0, 0.05) << off;
    EXPECT_GT(report.share, 0.9);
    EXPECT_EQ(report.share, static_cast<double>(report.used) / report.inside);
    EXPECT_NEAR(std::abs(fit.jump()), std::abs(off), 1.0);
    EXPECT_EQ(fit.covariance().rows(), 2);
    EXPECT_GT(report.evidence, 10.0);
  }
}

TEST(EdgeFit, LearnsNothingWhereNoEdgeIs) {
  EdgeFit fit{EdgeConfig()};
  Line line = lineAt(100.0);
  EXPECT_NE(fit.learn(border(150.0), line, kRange).reason, Reason::kNone);
  line = lineAt(150.0);
  EXPECT_NE(fit.learn(border(150.0, 1, false, [](cv::Mat1f& p) { p.setTo(90.0f); }), line, kRange).reason,
            Reason::kNone);
}

// What is remembered has a bright and a dark side: the same edge the other way round is another one.
TEST(EdgeFit, ReversedContrastIsAnotherEdge) {
  EdgeFit fit{EdgeConfig()};
  Line line = lineAt(150.0);
  ASSERT_EQ(fit.learn(border(150.0), line, kRange).reason, Reason::kNone);
  const Line expected = line;
  EXPECT_EQ(fit.fit(border(153.0, 2), expected, line, kRange, false, kAlways).reason, Reason::kNone);
  EXPECT_NEAR(placeOf(line), 153.0, 0.05);
  line = expected;
  EXPECT_NE(fit.fit(border(153.0, 3, true), expected, line, kRange, false, kAlways).reason, Reason::kNone);
}

// The brighter side is learnt whichever it is.
TEST(EdgeFit, EitherSideMayBeTheBrighterOne) {
  for (const bool is_reversed : {false, true}) {
    EdgeFit fit{EdgeConfig()};
    Line line = lineAt(152.0);
    EXPECT_EQ(fit.learn(border(150.0, 1, is_reversed), line, kRange).reason, Reason::kNone) << is_reversed;
    EXPECT_NEAR(placeOf(line), 150.0, 0.05) << is_reversed;
  }
}

// 35 % of it are asked for after a loss, 30 % otherwise: in between it depends on that alone.
TEST(EdgeFit, MoreIsAskedOfACurveThatComesBack) {
  EdgeConfig config;
  config.min_share = 0.3;
  config.min_return_share = 0.7;
  EdgeFit fit(config);
  Line line = lineAt(150.0);
  ASSERT_EQ(fit.learn(border(150.0), line, kRange).reason, Reason::kNone);
  const Line expected = line;
  const cv::Mat half = border(150.0, 2, false, [](cv::Mat1f& p) { p.rowRange(120, 240).setTo(120.0f); });
  EXPECT_EQ(fit.fit(half, expected, line, kRange, false, kAlways).reason, Reason::kNone);
  line = expected;
  const EdgeReport report = fit.fit(half, expected, line, kRange, true, kAlways);
  EXPECT_EQ(report.reason, Reason::kTooFewSites) << report.share << ' ' << reasonText(report.reason);
}

// Another edge nearby, of half the contrast: an edge that lies further away than it could has to look as it did.
TEST(EdgeFit, AJumpHasToLookAsItDid) {
  EdgeConfig config;
  config.min_similarity = 0.3;
  EdgeFit fit(config);
  Line line = lineAt(150.0);
  ASSERT_EQ(fit.learn(border(150.0), line, kRange).reason, Reason::kNone);
  const Line expected = line;
  test::EdgeScene faint;
  faint.bright = faint.dark + 0.5 * (faint.bright - faint.dark);
  const cv::Mat other = test::draw(faint, test::halfPlane(156.0, 0.0));
  EXPECT_EQ(fit.fit(other, expected, line, kRange, false, 10.0).reason, Reason::kNone) << "it may have moved so far";
  EXPECT_NEAR(placeOf(line), 156.0, 0.1);
  line = expected;
  EXPECT_EQ(fit.fit(other, expected, line, kRange, false, 2.0).reason, Reason::kJump);
}

// A fifth of each image: after some images with half of the contrast the old one is not asked for any more.
TEST(EdgeFit, TakesNewLooksIntoItsMemoryWhereItIsToldTo) {
  for (const bool remembers : {true, false}) {
    EdgeConfig config;
    config.min_similarity = 0.3;
    EdgeFit fit(config);
    Line line = lineAt(150.0);
    ASSERT_EQ(fit.learn(border(150.0), line, kRange).reason, Reason::kNone);
    test::EdgeScene faint;
    faint.bright = faint.dark + 0.5 * (faint.bright - faint.dark);
    const Line expected = line;
    for (unsigned k = 0; k < 25; ++k) {
      faint.seed = k + 2;
      line = expected;
      ASSERT_EQ(fit.fit(test::draw(faint, test::halfPlane(150.0, 0.0)), expected, line, kRange, false, kAlways).reason,
                Reason::kNone);
      if (remembers) fit.remember();
    }
    line = expected;
    const cv::Mat further = test::draw(faint, test::halfPlane(156.0, 0.0));
    EXPECT_EQ(fit.fit(further, expected, line, kRange, false, 2.0).reason, remembers ? Reason::kNone : Reason::kJump);
  }
}

// The covariance is what the curve scatters by along its normal.
TEST(EdgeFit, TellsHowFarItErrs) {
  double squares = 0.0, expected = 0.0;
  constexpr int kRuns = 40;
  for (unsigned k = 0; k < kRuns; ++k) {
    test::EdgeScene scene;
    scene.noise = 8.0;
    scene.seed = k + 1;
    EdgeFit fit{EdgeConfig()};
    Line line = lineAt(151.0);
    const EdgeReport report = fit.learn(test::draw(scene, test::halfPlane(150.0, 0.0)), line, kRange);
    ASSERT_EQ(report.reason, Reason::kNone) << k;
    squares += std::pow(placeOf(line) - 150.0, 2) / kRuns;
    expected += fit.covariance()(0, 0) / kRuns;
    EXPECT_GE(report.expected_error, std::sqrt(fit.covariance()(0, 0)) - 1e-9) << "at the worst site";
  }
  EXPECT_GT(expected, squares / 3.0);
  EXPECT_LT(expected, 6.0 * squares + 1e-3);
}

// One fit for every kind of curve.
TEST(EdgeFit, FollowsAnEllipseOfAnotherSize) {
  const auto disc = [](double a, double b, unsigned seed) {
    test::EdgeScene scene;
    scene.seed = seed;
    return test::draw(scene, test::ellipse({160.0, 120.0}, a, b, 0.4));
  };
  EdgeFit fit{EdgeConfig()};
  Ellipse ellipse({161.0, 119.0}, 51.0, 34.0, 0.4);
  ASSERT_EQ(fit.learn(disc(50.0, 35.0, 1), ellipse, kRange).reason, Reason::kNone);
  const Ellipse expected = ellipse;
  ASSERT_EQ(fit.fit(disc(53.0, 37.0, 2), expected, ellipse, kRange, false, kAlways).reason, Reason::kNone);
  EXPECT_LT((ellipse.centre() - Eigen::Vector2d(160.0, 120.0)).norm(), 0.1);
  EXPECT_NEAR(ellipse.change(expected), 53.0 / 50.0, 0.02);
  int in_image = 0;
  for (const SiteFinding& site : fit.findings()) {
    if (!site.inside || site.probe) continue;
    ++in_image;
    EXPECT_LT((site.edge - site.point).norm(), 1.5) << site.slot;
  }
  EXPECT_GT(in_image, 40);
}

}  // namespace
}  // namespace laparoscope_servo::features
