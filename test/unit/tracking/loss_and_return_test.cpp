// The region is covered altogether while the camera moves on, and comes back elsewhere, nearer, turned and tilted.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "laparoscope_servo/tracking/region_tracker.h"
#include "support/synthetic_tissue.h"

namespace laparoscope_servo::tracking {
namespace {

const cv::Size kSize(400, 320);
const geometry::Rectangle kRoi = {140, 100, 110, 110};
constexpr double kPeriod = 0.04;  // s
constexpr double kLie = 5.0;      // px
constexpr int kBefore = 4;
constexpr int kHidden = 12;
constexpr int kAfter = 24;

struct Return {
  double zoom;
  double angle;        // rad
  double tilt;         // rad
  Eigen::Vector2d to;  // px, of the ROI's centre
};

Eigen::Matrix3d motion(const Return& target, double share) {
  const Eigen::Vector2d from(kRoi.x + 0.5 * kRoi.width, kRoi.y + 0.5 * kRoi.height);
  const double zoom = std::pow(target.zoom, share);
  const double angle = target.angle * share;
  const Eigen::Vector2d to = from + share * (target.to - from);
  Eigen::Matrix3d tilted = Eigen::Matrix3d::Identity();
  tilted(0, 0) = std::cos(share * target.tilt);
  tilted(2, 0) = std::sin(share * target.tilt) / 450.0;
  return test::zoomAndTurn(kRoi, zoom, angle, tilted, to);
}

class LossAndReturnTest : public ::testing::Test {
 protected:
  cv::Mat scene_ = test::tissue(kSize, 61);
  cv::Mat other_ = test::tissue(kSize, 62);

  struct Outcome {
    int lies = 0;
    int first_after = -1;  // images from the first whole view to TRACKING; -1: never
    bool lost = false;     // it was not TRACKING at some time while hidden
    std::vector<TrackResult> results;
  };

  Outcome run(const Return& target, const cv::Mat& cover, const TrackerConfig& config = TrackerConfig()) const {
    RegionTracker tracker(config);
    tracker.select(test::view(scene_, motion(target, 0.0), 1.0, 0.0, 2.0), 0.0, kRoi);
    Outcome outcome;
    for (int frame = 1; frame < kBefore + kHidden + kAfter; ++frame) {
      const double share = std::clamp((frame - kBefore) / static_cast<double>(kHidden), 0.0, 1.0);
      const Eigen::Matrix3d g = motion(target, share);
      cv::Mat image = test::view(scene_, g, 1.0 + 0.01 * frame, 0.0, 2.0, 10 + frame);
      const bool hidden = frame >= kBefore && frame < kBefore + kHidden;
      if (hidden) image = test::view(cover, g, 1.0, 0.0, 2.0, 10 + frame);
      const TrackResult r = tracker.track(image, kPeriod * frame);
      const bool tracking = r.state == State::kTracking;
      // While hidden there is nothing to track: the first image may still be SEARCHING's cause.
      if (tracking && (hidden || geometry::cornerDistance(r.g, g, kRoi) >= kLie)) ++outcome.lies;
      if (hidden && !tracking) outcome.lost = true;
      if (!hidden && frame > kBefore && tracking && outcome.first_after < 0)
        outcome.first_after = frame - kBefore - kHidden;
      outcome.results.push_back(r);
    }
    return outcome;
  }
  static cv::Mat sheet() { return cv::Mat(kSize, CV_8UC3, cv::Scalar(170, 175, 180)); }
};

// At once, where the search may take as long as it needs; by the camera's period it needs a few images more.
TEST_F(LossAndReturnTest, ComesBackWhereverTheCameraWent) {
  TrackerConfig at_once;
  at_once.search.budget = 10.0;
  for (const Return& target : std::vector<Return>{{1.0, 0.0, 0.0, {255, 190}},
                                                  {0.7, 0.1, 0.0, {150, 120}},
                                                  {1.5, -0.1, 0.0, {200, 160}},
                                                  {1.0, 0.8, 0.0, {220, 140}},
                                                  {0.9, M_PI / 2, 0.0, {190, 170}},
                                                  {1.0, 0.0, 0.6, {210, 160}},
                                                  {1.2, -0.6, 0.3, {180, 150}}}) {
    for (const TrackerConfig& config : {TrackerConfig(), at_once}) {
      const Outcome outcome = run(target, sheet(), config);
      EXPECT_TRUE(outcome.lost);
      EXPECT_EQ(outcome.lies, 0) << target.zoom << ' ' << target.angle << ' ' << target.tilt;
      ASSERT_GE(outcome.first_after, 0) << target.zoom << ' ' << target.angle << ' ' << target.tilt << ": "
                                        << outcome.results.back().reason;
      EXPECT_GE(outcome.first_after, QualityConfig().confirmations - 1);
      EXPECT_LE(outcome.first_after, config.search.budget > 1.0 ? 4 : 12);
    }
  }
}

// Within a second, at 25 Hz.
TEST_F(LossAndReturnTest, IsBackWithinASecondForTurnsAndSizes) {
  for (const double zoom : {0.65, 1.0, 1.6}) {
    for (const double angle : {-M_PI / 3, 0.0, M_PI / 3}) {
      const Outcome outcome = run({zoom, angle, 0.0, {205, 160}}, sheet());
      EXPECT_TRUE(outcome.lost);
      EXPECT_EQ(outcome.lies, 0) << zoom << ' ' << angle;
      EXPECT_GE(outcome.first_after, 0) << zoom << ' ' << angle << ": " << outcome.results.back().reason;
    }
  }
}

TEST_F(LossAndReturnTest, TissueInFrontIsNotTakenForTheRegion) {
  const Outcome outcome = run({1.1, 0.3, 0.0, {220, 170}}, other_);
  EXPECT_TRUE(outcome.lost);
  EXPECT_EQ(outcome.lies, 0);
  EXPECT_GE(outcome.first_after, 0);
}

TEST_F(LossAndReturnTest, FeaturesAreWhatFindsATurnedRegion) {
  TrackerConfig config;
  config.search.features = false;
  const Return turned = {0.9, M_PI / 2, 0.0, {190, 170}};
  EXPECT_EQ(run(turned, sheet(), config).first_after, -1);
  config.search.features = true;
  config.search.correlation = false;
  EXPECT_GE(run(turned, sheet(), config).first_after, 0);
}

TEST_F(LossAndReturnTest, TheStateWaitsForAllConfirmations) {
  TrackerConfig config;
  config.quality.confirmations = 5;
  const Outcome outcome = run({1.0, 0.5, 0.0, {220, 170}}, sheet(), config);
  EXPECT_GE(outcome.first_after, 4);
  EXPECT_EQ(outcome.lies, 0);
}

TEST_F(LossAndReturnTest, NothingIsFoundInSmoke) {
  RegionTracker tracker{TrackerConfig()};
  tracker.select(scene_, 0.0, kRoi);
  for (int frame = 1; frame < 20; ++frame) {
    cv::Mat smoke(kSize, CV_8UC3, cv::Scalar(130, 130, 135));
    const TrackResult r =
        tracker.track(test::view(smoke, Eigen::Matrix3d::Identity(), 1.0, 0.0, 3.0, frame), kPeriod * frame);
    ASSERT_NE(r.state, State::kTracking) << frame;
    ASSERT_NE(r.reason, "");
  }
}

TEST_F(LossAndReturnTest, TheSameImagesGiveTheSameNumbers) {
  const Return target = {1.2, -0.6, 0.3, {180, 150}};
  const Outcome a = run(target, sheet());
  const Outcome b = run(target, sheet());
  ASSERT_EQ(a.results.size(), b.results.size());
  for (std::size_t k = 0; k < a.results.size(); ++k) {
    EXPECT_EQ(a.results[k].state, b.results[k].state);
    EXPECT_EQ(a.results[k].g, b.results[k].g);
    EXPECT_EQ(a.results[k].zncc, b.results[k].zncc);
  }
}

}  // namespace
}  // namespace laparoscope_servo::tracking
