// Thresholds that change between two images, without losing the region.
#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>
#include <stdexcept>
#include <string>

#include "laparoscope_servo/parameters/table.h"
#include "laparoscope_servo/tracking/region_tracker.h"
#include "support/synthetic_tissue.h"

namespace laparoscope_servo::tracking {
namespace {

const cv::Size kSize(320, 240);
const geometry::Rectangle kRoi = {110, 70, 100, 100};

class RegionTrackerRetune : public testing::Test {
 protected:
  RegionTrackerRetune() { tracker_.select(image(), 0.0, kRoi); }

  // The same tissue, each time with other noise, a third of the region covered.
  cv::Mat image(bool covered = false) {
    cv::Mat picture = test::view(scene_, Eigen::Matrix3d::Identity(), 1.0, 0.0, 2.0, ++seed_);
    if (covered) picture(cv::Rect(110, 70, 35, 100)).setTo(cv::Scalar::all(20));
    return picture;
  }
  TrackResult track(bool covered = false) { return tracker_.track(image(covered), 0.04 * ++count_); }

  cv::Mat scene_ = test::tissue(kSize, 61);
  int seed_ = 10;
  int count_ = 0;
  TrackerConfig config_;
  RegionTracker tracker_{config_};
};

TEST_F(RegionTrackerRetune, CountsFromTheNextImageOn) {
  ASSERT_EQ(track(true).state, State::kTracking);
  ASSERT_LT(track(true).visible_fraction, 0.8);
  config_.quality.min_visible_fraction = 0.95;
  config_.quality.min_return_fraction = 0.95;
  tracker_.retune(config_);
  const TrackResult strict = track(true);
  EXPECT_EQ(strict.state, State::kSearching);
  EXPECT_FALSE(strict.reason.empty());
  EXPECT_EQ(tracker_.config().quality.min_visible_fraction, 0.95);
}

TEST_F(RegionTrackerRetune, ConfirmationsCountAtOnce) {
  config_.quality.min_visible_fraction = config_.quality.min_return_fraction = 0.95;
  config_.quality.confirmations = 1;
  tracker_.retune(config_);
  ASSERT_EQ(track(true).state, State::kSearching);
  EXPECT_EQ(track(false).state, State::kTracking) << "one image is enough now";
}

TEST_F(RegionTrackerRetune, LosesNothing) {
  ASSERT_EQ(track().state, State::kTracking);
  for (int k = 0; k < 20; ++k) {
    config_.velocity_damping = k % 2 == 0 ? 0.0 : 1.0;
    config_.occlusion.threshold = k % 2 == 0 ? 0.4 : 0.6;
    config_.search.budget = k % 2 == 0 ? 0.001 : 0.1;
    config_.quality.max_jump = k % 2 == 0 ? 0.1 : 1.0;
    tracker_.retune(config_);
    const TrackResult result = track();
    ASSERT_EQ(result.state, State::kTracking) << result.reason;
    EXPECT_EQ(result.reference_stamp, 0.0);
  }
  EXPECT_TRUE(tracker_.hasRoi());
}

TEST_F(RegionTrackerRetune, WhatMayNotChangeStays) {
  config_.esm.levels = 1;
  config_.occlusion.rows = 3;
  config_.quality.min_zncc = 0.4;
  tracker_.retune(config_);
  EXPECT_EQ(tracker_.config().esm.levels, TrackerConfig().esm.levels);
  EXPECT_EQ(tracker_.config().occlusion.rows, TrackerConfig().occlusion.rows);
  EXPECT_EQ(tracker_.config().quality.min_zncc, 0.4);
  EXPECT_EQ(track().areas.rows, TrackerConfig().occlusion.rows);
}

TEST_F(RegionTrackerRetune, AConfigurationThatIsWrongIsRefused) {
  config_.quality.min_zncc = 0.4;
  config_.search.budget = -1.0;
  EXPECT_THROW(tracker_.retune(config_), std::invalid_argument);
  EXPECT_EQ(tracker_.config().quality.min_zncc, TrackerConfig().quality.min_zncc);
  EXPECT_EQ(track().state, State::kTracking);
}

// The tracker's results for a region that moves and grows, is covered bit by bit until it is lost, and is seen again at
// another place, a third of it covered. `smooth`: smooth tissue in a region without room for blocks, so that block
// matching decides nothing. After the selection the parameter `name` is set to `value`; empty: none.
std::string story(bool smooth, const std::string& name, double value) {
  const cv::Size size(240, 180);
  const geometry::Rectangle roi = {60, 50, smooth ? 28.0 : 80.0, 80};
  cv::Mat scene = test::tissue(size, 61);
  if (smooth) {
    cv::GaussianBlur(scene, scene, cv::Size(), 8.0);
    cv::normalize(scene, scene, 20.0, 230.0, cv::NORM_MINMAX);
  }
  TrackerConfig config;
  config.min_texture = 1.0;  // px: the small region is taken, too
  RegionTracker tracker(config);
  tracker.select(test::view(scene, Eigen::Matrix3d::Identity(), 1.0, 0.0, 2.0, 9), 0.0, roi);
  parameters::Table table;
  describe(table, config);
  if (!name.empty()) {
    const parameters::Row* row = table.find(name);
    const bool whole = row->kind == parameters::Row::Kind::kInteger;
    row->set(whole ? parameters::Value(static_cast<int>(value)) : parameters::Value(value));
    tracker.retune(config);
  }
  std::ostringstream results;
  for (int k = 1; k <= 40; ++k) {
    Eigen::Matrix3d g = Eigen::Matrix3d::Identity();
    g(0, 0) = g(1, 1) = 1.0 + 0.004 * std::min(k, 30);
    g(0, 2) = k <= 30 ? 1.5 * k * (k > 3) : -30.0;
    cv::Mat image = test::view(scene, g, 1.0, 0.0, 2.0, static_cast<unsigned>(100 + k));
    const int covered = k <= 6 ? 0 : k <= 30 ? 10 * (k - 2) : 65;  // px, from the left
    image.colRange(0, std::min(covered, size.width)).setTo(cv::Scalar(20, 20, 20));
    const TrackResult& result = tracker.track(image, 0.04 * k);
    results << static_cast<int>(result.state) << ' ' << result.reason << ' ' << result.iterations << ' '
            << result.visible_fraction << ' ' << result.g << '\n';
  }
  return results.str();
}

// A value that is accepted and logged, but not passed on to the part that uses it, would have no effect.
TEST(RegionTrackerRetuneEach, EveryParameterThatMayChangeHasAnEffect) {
  TrackerConfig config;
  parameters::Table table;
  describe(table, config);
  const std::string as_before[] = {story(false, "", 0.0), story(true, "", 0.0)};
  int changeable = 0;
  for (const parameters::Row& row : table.rows()) {
    if (!row.while_running) continue;
    ++changeable;
    bool has_effect = false;
    for (const bool smooth : {false, true}) {
      for (const double value : {row.range.low, row.range.high}) {
        has_effect = has_effect || story(smooth, row.name, value) != as_before[smooth ? 1 : 0];
      }
    }
    EXPECT_TRUE(has_effect) << row.name;
  }
  EXPECT_GT(changeable, 0);
}

TEST_F(RegionTrackerRetune, HoldsAcrossAReset) {
  config_.quality.confirmations = 1;
  tracker_.retune(config_);
  tracker_.reset();
  EXPECT_EQ(tracker_.config().quality.confirmations, 1);
  tracker_.select(image(), 10.0, kRoi);
  EXPECT_EQ(tracker_.config().quality.confirmations, 1);
}

}  // namespace
}  // namespace laparoscope_servo::tracking
