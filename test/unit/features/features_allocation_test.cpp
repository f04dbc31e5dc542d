// Tracking features asks for no memory once it is under way.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "laparoscope_servo/features/curve_tracker.h"
#include "laparoscope_servo/features/dot_feature_tracker.h"
#include "laparoscope_servo/features/dots.h"
#include "laparoscope_servo/features/edge_feature_tracker.h"
#include "laparoscope_servo/features/ellipse.h"
#include "laparoscope_servo/features/line.h"
#include "laparoscope_servo/features/point_feature_tracker.h"
#include "laparoscope_servo/features/spline.h"
#include "support/allocation_counter.h"
#include "support/synthetic_edges.h"
#include "support/synthetic_tissue.h"

namespace laparoscope_servo::features {
namespace {

constexpr int kImages = 12;
constexpr int kCovered = 8;  // from this image on: the search asks for none either

// A disc, whose outline is a dot's and an ellipse's, beside the border of a half plane.
std::vector<cv::Mat> images() {
  std::vector<cv::Mat> result;
  for (int k = 0; k < kImages; ++k) {
    test::EdgeScene scene;
    scene.seed = static_cast<unsigned>(k + 1);
    const test::Region disc = test::ellipse({90.0 + k, 120.0}, 25.0, 22.0, 0.3), half = test::halfPlane(220.0 + k, 0.0);
    result.push_back(test::draw(
        scene, [&](const Eigen::Vector2d& p) { return disc(p) || half(p); },
        [&](cv::Mat1f& pixels) {
          if (k >= kCovered) pixels.setTo(100.0f);
        }));
  }
  return result;
}

struct ByTheInterface {
  FeatureTracker& tracker;
  const TrackedFeatures& track(const cv::Mat& image, double stamp) { return tracker.track(image, stamp, prior); }
  FeaturePrior prior;
};

template <class Tracker>
void expectNoAllocations(Tracker& tracker) {
#ifndef COUNTS_ALLOCATIONS
  GTEST_SKIP() << "allocations can be counted with glibc's own allocator only";
#endif
  const std::vector<cv::Mat> sequence = images();
  for (int k = 1; k < kImages; ++k) {
    allocations = 0;
    counting = true;
    const State state = tracker.track(sequence[static_cast<std::size_t>(k)], 0.04 * k).state;
    counting = false;
    EXPECT_EQ(state, k < kCovered ? State::kTracking : State::kSearching) << "image " << k;
    EXPECT_EQ(allocations, 0) << "image " << k;
  }
}

TEST(FeaturesAllocation, thereIsNoneForALine) {
  CurveTracker<Line> tracker;
  tracker.select(images()[0], 0.0, Line({220.0, 30.0}, {220.0, 200.0}));
  expectNoAllocations(tracker);
}

TEST(FeaturesAllocation, thereIsNoneForAnEllipse) {
  CurveTracker<Ellipse> tracker;
  tracker.select(images()[0], 0.0, Ellipse({90.0, 120.0}, 25.0, 22.0, 0.3));
  expectNoAllocations(tracker);
}

TEST(FeaturesAllocation, thereIsNoneForASpline) {
  CurveTracker<Spline> tracker;
  const Ellipse outline({90.0, 120.0}, 25.0, 22.0, 0.3);
  std::vector<Eigen::Vector2d> points;
  for (int k = 0; k < 8; ++k) points.push_back(outline.at(0.25 * M_PI * k));
  tracker.select(images()[0], 0.0, Spline::throughPoints(points, true));
  expectNoAllocations(tracker);
}

TEST(FeaturesAllocation, thereIsNoneForDots) {
  DotTracker tracker;
  tracker.select(images()[0], 0.0, {{90.0, 120.0}});
  expectNoAllocations(tracker);
}

TEST(FeaturesAllocation, thereIsNoneBehindTheInterface) {
  FeatureSelection selection(2);
  selection[0].id = "border";
  selection[0].kind = FeatureKind::kLine;
  selection[0].points = {{220.0, 30.0}, {220.0, 200.0}};
  selection[1].id = "rim";
  selection[1].kind = FeatureKind::kEllipse;
  selection[1].ellipse = EllipseSelection{{90.0, 120.0}, 25.0, 22.0, 0.3};
  EdgeFeatureTracker edges;
  edges.select(images()[0], 0.0, selection, {});
  ByTheInterface behind{edges, {}};
  expectNoAllocations(behind);

  FeatureSelection dot(1);
  dot[0].id = "dot";
  dot[0].points = {{90.0, 120.0}};
  DotFeatureTracker dots;
  dots.select(images()[0], 0.0, dot, {});
  ByTheInterface behind_dots{dots, {}};
  expectNoAllocations(behind_dots);
}

// Also while some are searched for; not when hardly any is seen, and the first view is matched as a whole.
TEST(FeaturesAllocation, thereIsNoneForPoints) {
#ifndef COUNTS_ALLOCATIONS
  GTEST_SKIP() << "allocations can be counted with glibc's own allocator only";
#endif
  std::vector<cv::Mat> sequence;
  const cv::Mat scene = test::tissue({320, 240}, 4);
  for (int k = 0; k < kImages; ++k) {
    Eigen::Matrix3d g = Eigen::Matrix3d::Identity();
    g(0, 2) = 1.5 * k;
    sequence.push_back(test::view(scene, g, 1.0, 0.0, 1.0, static_cast<unsigned>(k)));
    if (k >= 4 && k < kCovered) sequence.back().colRange(0, 150).setTo(cv::Scalar::all(70));
  }
  FeatureSelection selection(1);
  selection[0].id = "tissue";
  selection[0].corners = CornerSelection{{}, 30};
  PointFeatureTracker tracker;
  ASSERT_GT(tracker.select(sequence[0], 0.0, selection, {}).features.size(), 20u);
  int searched = 0;
  for (int k = 1; k < kImages; ++k) {
    allocations = 0;
    counting = true;
    const TrackedFeatures& told = tracker.track(sequence[static_cast<std::size_t>(k)], 0.04 * k, {});
    counting = false;
    EXPECT_EQ(allocations, 0) << "image " << k;
    for (const TrackedFeature& feature : told.features) searched += feature.state == State::kSearching ? 1 : 0;
  }
  EXPECT_GT(searched, 20);
}

}  // namespace
}  // namespace laparoscope_servo::features
