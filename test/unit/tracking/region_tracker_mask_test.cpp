// The tracker with a mask of what instruments cover, from the simulated camera, which knows.
#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgproc.hpp>

#include "laparoscope_servo/sim/scope_camera.h"
#include "laparoscope_servo/tracking/region_tracker.h"
#include "support/error_text.h"

namespace laparoscope_servo::tracking {
namespace {

const geometry::Rectangle kRoi = {290, 190, 100, 100};
const geometry::Rectangle kBeside = {220, 200, 100, 100};
constexpr double kPeriod = 0.04;  // s

class RegionTrackerMask : public ::testing::Test {
 protected:
  RegionTrackerMask() : camera_(config(), sim::placeTissue(config().tissue, Eigen::Isometry3d::Identity())) {}

  static sim::SceneConfig config() {
    sim::SceneConfig config;
    config.tissue.texture_side = 1200;
    config.instrument.radius = 0.0035;
    return config;
  }
  // The camera drifts; the shaft lies over the region, and leaves it sideways between images 20 and 40.
  static Eigen::Isometry3d pose(int k) {
    return Eigen::Isometry3d(Eigen::Translation3d(0.0001 * k, -0.00005 * k, 0.0));
  }
  static std::optional<Eigen::Vector3d> tip(int k) {
    if (k >= 40) return std::nullopt;
    return Eigen::Vector3d(-0.012 + 0.003 * std::max(0, k - 20), -0.010, -0.02);
  }
  sim::RenderedImage render(int k) { return camera_.render(pose(k), k * kPeriod, tip(k)); }
  static Eigen::Matrix3d truth(int k) {
    return geometry::pixelsFromPlane(pose(k).inverse(), Eigen::Vector3d::UnitZ(), config().tissue.distance,
                                     config().camera.intrinsics);
  }

  sim::ScopeCamera camera_;
  RegionTracker tracker_{TrackerConfig()};
};

TEST_F(RegionTrackerMask, SelectedUnderAShaftTheRegionIsTrackedWhenItLeaves) {
  const sim::RenderedImage first = render(0);
  const cv::Rect box(static_cast<int>(kRoi.x), static_cast<int>(kRoi.y), static_cast<int>(kRoi.width),
                     static_cast<int>(kRoi.height));
  const double covered = cv::countNonZero(first.instrument_mask(box)) / (kRoi.width * kRoi.height);
  ASSERT_GT(covered, 1.0 / 3.0);
  ASSERT_LT(covered, 0.6);
  const TrackResult selected = tracker_.select(first.image, 0.0, kRoi, first.instrument_mask);
  // What the mask covers is not used: neither now nor later.
  EXPECT_NEAR(selected.visible_fraction, 1.0 - covered, 0.05);
  for (int k = 1; k < 70; ++k) {
    const sim::RenderedImage now = render(k);
    const TrackResult& result = tracker_.track(now.image, k * kPeriod, std::nullopt, now.instrument_mask);
    ASSERT_EQ(result.state, State::kTracking) << k << ' ' << result.reason;
    // While half of it is covered the corners there follow those that are seen.
    EXPECT_LT(geometry::cornerDistance(result.g, truth(k), kRoi), k < 40 ? 8.0 : 2.0) << k;
    EXPECT_LE(result.visible_fraction, 1.0 - covered + 0.02) << k;
  }
}

// What the image of the selection itself shows of an instrument is left out without a mask, too.
TEST_F(RegionTrackerMask, OfARegionPartlyUnderAShaftOnlyTheTissueIsUsed) {
  const sim::RenderedImage first = render(0);
  const cv::Rect box(static_cast<int>(kBeside.x), static_cast<int>(kBeside.y), static_cast<int>(kBeside.width),
                     static_cast<int>(kBeside.height));
  const double covered = cv::countNonZero(first.instrument_mask(box)) / (kBeside.width * kBeside.height);
  ASSERT_GT(covered, 0.2);
  ASSERT_LT(covered, 0.45);
  EXPECT_NEAR(tracker_.select(first.image, 0.0, kBeside).visible_fraction, 1.0 - covered, 0.07);
  for (int k = 1; k < 70; ++k) {
    const TrackResult& result = tracker_.track(render(k).image, k * kPeriod);
    ASSERT_EQ(result.state, State::kTracking) << k << ' ' << result.reason;
    EXPECT_LT(geometry::cornerDistance(result.g, truth(k), kBeside), k < 40 ? 8.0 : 2.0) << k;
  }
}

TEST_F(RegionTrackerMask, ARegionOnAShaftIsRefusedAndOneBesideItIsProposed) {
  const sim::RenderedImage first = render(0);
  const cv::Rect shaft = cv::boundingRect(first.instrument_mask);
  // About the middle of what is seen of it.
  const cv::Moments moments = cv::moments(first.instrument_mask, true);
  const geometry::Rectangle roi = {std::floor(moments.m10 / moments.m00) - 20,
                                   std::floor(moments.m01 / moments.m00) - 20, 40, 40};
  ASSERT_GT(shaft.area(), 0);
  const auto refusal = [&](const geometry::Rectangle& r) {
    return test_support::errorText<std::invalid_argument>([&] { tracker_.check(first.image, r); });
  };
  EXPECT_NE(refusal(roi).find(" lies on an instrument by "), std::string::npos) << refusal(roi);
  EXPECT_THROW(tracker_.select(first.image, 0.0, roi), std::invalid_argument);
  EXPECT_THROW(tracker_.recall(first.image, 0.0, roi, 1.0), std::invalid_argument);
  EXPECT_FALSE(tracker_.hasRoi());
  const auto proposal = tracker_.propose(first.image, roi);
  ASSERT_TRUE(proposal);
  EXPECT_EQ(refusal(*proposal), "");
  const cv::Rect box(static_cast<int>(proposal->x), static_cast<int>(proposal->y), static_cast<int>(proposal->width),
                     static_cast<int>(proposal->height));
  EXPECT_LT(cv::countNonZero(first.instrument_mask(box)), 0.1 * box.area());
}

TEST_F(RegionTrackerMask, AMaskOfNothingChangesNothing) {
  RegionTracker without{TrackerConfig()};
  const cv::Mat nothing = cv::Mat::zeros(480, 640, CV_8UC1);
  const sim::RenderedImage first = render(0);
  without.select(first.image, 0.0, kRoi);
  tracker_.select(first.image, 0.0, kRoi, nothing);
  for (int k = 1; k < 30; ++k) {
    const sim::RenderedImage now = render(k);
    const TrackResult& a = without.track(now.image, k * kPeriod);
    const TrackResult& b = tracker_.track(now.image, k * kPeriod, std::nullopt, nothing);
    EXPECT_EQ(a.state, b.state) << k;
    EXPECT_EQ(a.g, b.g) << k;
    EXPECT_EQ(a.corner_error, b.corner_error) << k;
  }
}

TEST_F(RegionTrackerMask, WhatItCoversDoesNotDriveTheEstimate) {
  const cv::Mat image = camera_.render(pose(0), 0.0).image;
  tracker_.select(image, 0.0, kRoi);
  cv::Mat mask = cv::Mat::zeros(image.size(), CV_8UC1);
  mask(cv::Rect(290, 190, 50, 100)).setTo(255);
  const TrackResult& result = tracker_.track(image, kPeriod, std::nullopt, mask);
  EXPECT_EQ(result.state, State::kTracking);
  EXPECT_NEAR(result.visible_fraction, 0.5, 0.05);
  // And only in the image that it is of.
  EXPECT_GT(tracker_.track(image, 2.0 * kPeriod).visible_fraction, 0.9);
}

TEST_F(RegionTrackerMask, AMaskOfAnotherSizeOrTypeIsRefusedAndTrackingGoesOn) {
  const sim::RenderedImage first = render(45);
  const cv::Mat small(240, 320, CV_8UC1, cv::Scalar(0)), wide(480, 640, CV_8UC3, cv::Scalar(0));
  EXPECT_THROW(tracker_.select(first.image, 0.0, kRoi, small), std::invalid_argument);
  tracker_.select(first.image, 0.0, kRoi);
  EXPECT_THROW(tracker_.track(first.image, kPeriod, std::nullopt, small), std::invalid_argument);
  EXPECT_THROW(tracker_.track(first.image, kPeriod, std::nullopt, wide), std::invalid_argument);
  EXPECT_EQ(tracker_.track(first.image, kPeriod).state, State::kTracking);
}

}  // namespace
}  // namespace laparoscope_servo::tracking
