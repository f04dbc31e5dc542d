// Splines through images whose truth is known: how far off, with sites astray and under cover.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "laparoscope_servo/features/curve_tracker.h"
#include "laparoscope_servo/features/spline.h"
#include "support/synthetic_contour.h"

namespace laparoscope_servo::features {
namespace {

const Eigen::Vector2d kMiddle(160.0, 120.0);
constexpr double kRadius = 75.0;

test::EdgeScene sceneOf(int image) {
  test::EdgeScene scene;
  scene.seed = static_cast<unsigned>(image + 1);
  return scene;
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values.at(values.size() / 2);
}

double largest(const std::vector<double>& values) {
  return *std::max_element(values.begin(), values.end());
}

// A texture with edges of its own over the directions, seen from the contour's centre, that `isCovered`.
template <class IsCovered>
std::function<void(cv::Mat1f&)> cover(const test::Contour& truth, const IsCovered& isCovered) {
  return [truth, isCovered](cv::Mat1f& pixels) {
    const cv::Mat1f texture = test::texture(pixels.size(), 110.0, 25.0, 3.0, 7);
    for (int v = 0; v < pixels.rows; ++v) {
      for (int u = 0; u < pixels.cols; ++u) {
        const double angle = std::atan2(v - truth.centre.y(), u - truth.centre.x());
        if (isCovered(angle)) pixels(v, u) = texture(v, u);
      }
    }
  };
}

TEST(SplineTracker, followsAContourThatDeforms) {
  CurveTracker<Spline> tracker;
  std::vector<double> errors;
  for (int k = 0; k < 25; ++k) {
    const test::Contour truth(k, kMiddle, kRadius);
    const cv::Mat image = test::draw(sceneOf(k), truth.region());
    if (k == 0) {
      tracker.select(image, 0.0, Spline::throughPoints(truth.points(12), true));
      continue;
    }
    const CurveResult<Spline>& result = tracker.track(image, 0.04 * k);
    ASSERT_EQ(result.state, State::kTracking) << "image " << k << ": " << reasonText(result.reason);
    const std::vector<double> distances = truth.errors(result.curve);
    EXPECT_LT(largest(distances), std::max(0.4, 4.0 * result.expected_error)) << "image " << k;
    errors.push_back(median(distances));
  }
  EXPECT_LT(median(errors), 0.1);
}

// Six pieces of the contour, three tenths of it, show other edges.
TEST(SplineTracker, bearsThatThreeTenthsOfTheSitesAreAstray) {
  CurveTracker<Spline> tracker;
  std::vector<double> errors;
  for (int k = 0; k < 25; ++k) {
    const test::Contour truth(k, kMiddle, kRadius);
    const auto is_astray = [](double angle) { return std::fmod(angle + M_PI, M_PI / 3.0) < 0.3 * M_PI / 3.0; };
    const cv::Mat image = test::draw(sceneOf(k), truth.region(), k == 0 ? nullptr : cover(truth, is_astray));
    if (k == 0) {
      tracker.select(image, 0.0, Spline::throughPoints(truth.points(12), true));
      continue;
    }
    const CurveResult<Spline>& result = tracker.track(image, 0.04 * k);
    ASSERT_EQ(result.state, State::kTracking) << "image " << k << ": " << reasonText(result.reason);
    errors.push_back(median(truth.errors(result.curve)));
  }
  EXPECT_LT(median(errors), 0.2);
}

// What is covered for long follows the whole, and is found again.
TEST(SplineTracker, aPieceThatIsCoveredDoesNotWander) {
  CurveTracker<Spline> tracker;
  for (int k = 0; k < 40; ++k) {
    const test::Contour truth(k, kMiddle, kRadius, 0.0);
    const bool covered = k > 2 && k < 32;
    const auto is_covered = [](double angle) { return std::abs(angle) < 0.3 * M_PI; };
    const cv::Mat image = test::draw(sceneOf(k), truth.region(), covered ? cover(truth, is_covered) : nullptr);
    if (k == 0) {
      tracker.select(image, 0.0, Spline::throughPoints(truth.points(12), true));
      continue;
    }
    const CurveResult<Spline>& result = tracker.track(image, 0.04 * k);
    ASSERT_EQ(result.state, State::kTracking) << "image " << k << ": " << reasonText(result.reason);
    EXPECT_LT(largest(truth.errors(result.curve)), covered ? 4.0 : k > 34 ? 0.5 : 5.0) << "image " << k;
    if (covered) {
      EXPECT_LT(result.share, 0.85);
    }
  }
}

TEST(SplineTracker, followsAnOpenCurveThatShifts) {
  const auto height = [](double x, int k) { return 100.0 + 15.0 * std::sin(x / 40.0) + 1.5 * k; };
  std::vector<Eigen::Vector2d> points;
  for (double x = 40.0; x < 290.0; x += 20.0) points.emplace_back(x, height(x, 0));
  CurveTracker<Spline> tracker;
  for (int k = 0; k < 15; ++k) {
    const cv::Mat image = test::draw(sceneOf(k), [&](const Eigen::Vector2d& p) { return p.y() > height(p.x(), k); });
    if (k == 0) {
      tracker.select(image, 0.0, Spline::throughPoints(points, false));
      continue;
    }
    const CurveResult<Spline>& result = tracker.track(image, 0.04 * k);
    ASSERT_EQ(result.state, State::kTracking) << "image " << k << ": " << reasonText(result.reason);
    for (double t = 0.0; t <= result.curve.pieces(); t += 0.5) {
      const Eigen::Vector2d p = result.curve.at(t);
      EXPECT_NEAR(p.y(), height(p.x(), k), 0.5) << "image " << k;
    }
  }
}

TEST(SplineTracker, claimsNoneWhenTheContourIsCovered) {
  CurveTracker<Spline> tracker;
  for (int k = 0; k < 12; ++k) {
    const test::Contour truth(k, kMiddle, kRadius);
    const cv::Mat image =
        test::draw(sceneOf(k), truth.region(), k < 4 ? nullptr : cover(truth, [](double) { return true; }));
    if (k == 0) {
      tracker.select(image, 0.0, Spline::throughPoints(truth.points(12), true));
      continue;
    }
    EXPECT_EQ(tracker.track(image, 0.04 * k).state, k < 4 ? State::kTracking : State::kSearching) << "image " << k;
  }
}

}  // namespace
}  // namespace laparoscope_servo::features
