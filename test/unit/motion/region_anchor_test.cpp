// A region by its first image: without drift, and found again after something has hidden it.
#include "motion/region_anchor.h"

#include <gtest/gtest.h>

#include <cmath>

#include "motion/motion_sequence.h"
#include "support/synthetic_motion.h"

namespace laparoscope_servo::motion {
namespace {

using features::State;

const geometry::Rectangle kRegion{110.0, 80.0, 96.0, 80.0};

Eigen::Vector2d swing(int k) {
  return {12.0 * std::sin(0.12 * k), 7.0 * std::sin(0.19 * k)};
}

Eigen::Matrix3d shiftBy(const Eigen::Vector2d& by) {
  Eigen::Matrix3d g = Eigen::Matrix3d::Identity();
  g.topRightCorner<2, 1>() = by;
  return g;
}

cv::Mat imageOf(int k) {
  static const cv::Mat scene = test::tissue({test::kMotionWidth, test::kMotionHeight}, 5);
  return test::view(scene, shiftBy(swing(k)), 1.0, 0.0, 2.0, static_cast<unsigned>(100 + k));
}

double errorOf(const MotionResult& result, int k) {
  return geometry::largestDistance(result.region, geometry::apply(shiftBy(swing(k)), kRegion.corners()));
}

TEST(RegionAnchorTest, TheRegionDoesNotDrift) {
  MotionSequence sequence{MotionConfig()};
  sequence.begin(imageOf(0), 0.0, kRegion, {});
  Eigen::Matrix3d steps = Eigen::Matrix3d::Identity();
  double worst = 0.0;
  for (int k = 1; k <= 100; ++k) {
    const MotionResult& result = sequence.track(imageOf(k), 0.04 * k, std::nullopt, {});
    ASSERT_EQ(result.state, State::kTracking) << k;
    steps = result.g * steps;
    worst = std::max(worst, errorOf(result, k));
  }
  const double drifted = geometry::largestDistance(geometry::apply(steps, kRegion.corners()),
                                                   geometry::apply(shiftBy(swing(100)), kRegion.corners()));
  std::printf("worst corner %.2f px; by the steps alone %.2f px at the end\n", worst, drifted);
  EXPECT_LT(worst, 0.25);
  EXPECT_GT(drifted, 0.5) << "else nothing is shown";
}

// Something with another texture lies in its place for half a second, at rest in the image: its motion is not the
// region's.
TEST(RegionAnchorTest, WhatHidesTheRegionIsNotFollowedAndTheRegionIsFoundAgain) {
  MotionSequence sequence{MotionConfig()};
  sequence.begin(imageOf(0), 0.0, kRegion, {});
  for (int k = 1; k <= 60; ++k) {
    cv::Mat image = imageOf(k);
    const bool is_hidden = k > 20 && k <= 32;
    if (is_hidden) test::cover(image, 0, cv::Rect(70, 40, 180, 160), {0.0, 0.0});
    const MotionResult& result = sequence.track(image, 0.04 * k, std::nullopt, {});
    if (k <= 20 || k > 40) {
      EXPECT_EQ(result.state, State::kTracking) << k << ": " << reasonText(result.reason);
      EXPECT_LT(errorOf(result, k), 0.3) << k;
    } else if (is_hidden) {
      EXPECT_NE(result.state, State::kTracking) << k;
    }
    if (result.state == State::kTracking) {
      EXPECT_LT(errorOf(result, k), 0.5) << k;
    }
  }
}

TEST(RegionAnchorTest, WhatContradictsTheStepsIsNotBelieved) {
  RegionAnchor anchor{MotionConfig()};
  const cv::Rect box(62, 40, 192, 160);
  MotionImage there;
  const cv::Mat image = imageOf(0);
  anchor.begin(image, {}, box, kRegion.corners());
  there.take(image(box), {}, MotionConfig());
  anchor.goOn(Eigen::Matrix3d::Identity(), 0.05);
  EXPECT_TRUE(anchor.compare(there, box));
  EXPECT_LT(geometry::largestDistance(anchor.region(), kRegion.corners()), 0.1);
  anchor.goOn(shiftBy({4.0, 0.0}), 0.05);  // the image has not moved
  EXPECT_FALSE(anchor.compare(there, box));
  EXPECT_FALSE(anchor.isKnown());
  anchor.goOn(Eigen::Matrix3d::Identity(), std::numeric_limits<double>::infinity());
  EXPECT_TRUE(anchor.compare(there, box)) << "where nothing else is known, it is";
  EXPECT_TRUE(anchor.isKnown());
}

}  // namespace
}  // namespace laparoscope_servo::motion
