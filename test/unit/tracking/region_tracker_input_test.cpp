// Images, regions and configurations that are none, and streams that start again.
#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "region_tracker_fixture.h"
#include "support/error_text.h"

namespace laparoscope_servo::tracking {
namespace {

using RegionTrackerInputTest = RegionTrackerTest;

TEST_F(RegionTrackerInputTest, TimeThatJumpsBackResets) {
  select();
  ASSERT_EQ(tracker_.track(image(1), 10.0).state, State::kTracking);
  const TrackResult r = tracker_.track(image(2), 9.0);
  EXPECT_EQ(r.state, State::kIdle);
  EXPECT_NE(r.reason.find("jumped back"), std::string::npos);
  EXPECT_FALSE(tracker_.hasRoi());
}

TEST_F(RegionTrackerInputTest, AnotherSizeResets) {
  select();
  const TrackResult r = tracker_.track(cv::Mat(100, 120, CV_8UC3, cv::Scalar(1, 2, 3)), 1.0);
  EXPECT_EQ(r.state, State::kIdle);
  EXPECT_NE(r.reason.find("360 x 300 to 120 x 100"), std::string::npos) << r.reason;
}

TEST_F(RegionTrackerInputTest, ImagesThatAreNoneAreRefusedAndChangeNothing) {
  select();
  EXPECT_THROW(tracker_.track(cv::Mat(), 0.04), std::invalid_argument);
  EXPECT_THROW(tracker_.track(cv::Mat(kSize, CV_16UC1, cv::Scalar(1)), 0.04), std::invalid_argument);
  EXPECT_THROW(tracker_.track(image(1), std::nan("")), std::invalid_argument);
  EXPECT_THROW(tracker_.select(scene_, std::nan(""), kRoi), std::invalid_argument);
  EXPECT_THROW(tracker_.recall(scene_, 0.0, kRoi, std::nan("")), std::invalid_argument);
  EXPECT_THROW(tracker_.recall(scene_, std::nan(""), kRoi, 0.0), std::invalid_argument);
  EXPECT_EQ(tracker_.track(image(1), 0.04).state, State::kTracking);
}

TEST_F(RegionTrackerInputTest, BadRegionsAreRefusedByNameAndTheOldOneStays) {
  select();
  const cv::Mat now = image(1);
  const double nan = std::nan("");
  for (const geometry::Rectangle& roi : std::vector<geometry::Rectangle>{{0, 0, 0, 0},
                                                                         {10, 10, 15, 50},
                                                                         {-1, 0, 50, 50},
                                                                         {300, 250, 100, 100},
                                                                         {1000, 1000, 50, 50},
                                                                         {nan, 0, 50, 50},
                                                                         {0, 0, nan, 50},
                                                                         {0, 0, 1e9, 1e9}}) {
    EXPECT_THROW(tracker_.select(now, 0.04, roi), std::invalid_argument) << roi.x << ' ' << roi.width;
  }
  try {
    tracker_.select(cv::Mat(kSize, CV_8UC3, cv::Scalar(90, 90, 90)), 0.04, kRoi);
    FAIL() << "a region without texture was accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("texture"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("width=112"), std::string::npos) << error.what();
  }
  EXPECT_EQ(tracker_.track(now, 0.04).state, State::kTracking);
}

TEST_F(RegionTrackerInputTest, ARegionIsCheckedAsItWouldBeSelectedAndNothingChanges) {
  const cv::Mat image = this->image(1);
  EXPECT_NO_THROW(tracker_.check(image, kRoi));
  EXPECT_FALSE(tracker_.hasRoi());
  select();
  const auto whyNot = [&](const geometry::Rectangle& roi, bool check) -> std::string {
    RegionTracker fresh{TrackerConfig()};
    return test_support::errorText<std::invalid_argument>([&] {
      if (check) {
        tracker_.check(image, roi);
      } else {
        fresh.select(image, 0.0, roi);
      }
    });
  };
  for (const geometry::Rectangle& roi :
       {kRoi, geometry::Rectangle{300, 80, 112, 112}, geometry::Rectangle{10, 10, 3, 50}, geometry::Rectangle{}}) {
    EXPECT_EQ(whyNot(roi, true), whyNot(roi, false));
  }
  EXPECT_NE(whyNot({300, 80, 112, 112}, true), "");
  EXPECT_NE(whyNot({10, 10, 3, 50}, true), "");
  EXPECT_THROW(tracker_.check(cv::Mat(), kRoi), std::invalid_argument);
  const TrackResult& result = tracker_.track(image, 0.05);
  EXPECT_EQ(result.state, State::kTracking) << result.reason;
  EXPECT_EQ(result.roi.x, kRoi.x);
}

TEST_F(RegionTrackerInputTest, ARegionSmallerThanTheGridOfAreasIsRefusedWithTheReason) {
  TrackerConfig config;
  config.occlusion.columns = 40;
  RegionTracker tracker(config);
  EXPECT_THROW(tracker.select(image(0), 0.0, {100, 100, 30, 60}), std::invalid_argument);
}

TEST_F(RegionTrackerInputTest, ABadConfigurationIsRefusedWithEveryError) {
  TrackerConfig config;
  config.esm.levels = 0;
  config.occlusion.bins = 1;
  try {
    const RegionTracker tracker(config);
    FAIL() << "accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("esm/levels"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("occlusion/bins"), std::string::npos);
  }
}

}  // namespace
}  // namespace laparoscope_servo::tracking
