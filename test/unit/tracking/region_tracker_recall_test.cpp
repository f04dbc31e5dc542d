// An older image is the reference: its region has to be found in the images that come.
#include <stdexcept>

#include "region_tracker_fixture.h"

namespace laparoscope_servo::tracking {
namespace {

constexpr double kNow = 100.0;  // s

class RegionTrackerRecallTest : public RegionTrackerTest {
 protected:
  // Far from the reference in place, turn and scale.
  const Eigen::Matrix3d g_ = test::zoomAndTurn(kRoi, 1.25, 0.5, Eigen::Matrix3d::Identity(), {190.0, 150.0});

  // Images until the tracker says TRACKING; -1 when it does not within ten.
  int imagesUntilFound(double gain = 1.0) {
    for (int k = 1; k <= 10; ++k) {
      last_ = tracker_.track(test::view(scene_, g_, gain, 0.0, 2.0, k), kNow + 0.04 * k);
      if (last_.state == State::kTracking) return k;
      EXPECT_EQ(last_.state, State::kSearching);
      EXPECT_NE(last_.reason, "");
    }
    return -1;
  }
  TrackResult last_;
};

TEST_F(RegionTrackerRecallTest, FindsTheRegionOfAnOlderImageWhenConfirmed) {
  TrackerConfig config;
  config.search.budget = 10.0;  // s: at once
  tracker_ = RegionTracker(config);
  tracker_.recall(scene_, 3.0, kRoi, kNow);
  EXPECT_TRUE(tracker_.hasRoi());
  EXPECT_EQ(imagesUntilFound(), TrackerConfig().quality.confirmations);
  EXPECT_LT(geometry::cornerDistance(last_.g, g_, kRoi), 1.0);
  EXPECT_EQ(last_.reference_stamp, 3.0);
}

TEST_F(RegionTrackerRecallTest, BearsTheChangeOfLightThatCameInTheMeantime) {
  tracker_.recall(scene_, 3.0, kRoi, kNow);
  EXPECT_GT(imagesUntilFound(0.45), 0);
}

TEST_F(RegionTrackerRecallTest, SearchesAndIsLostWhenItIsNotThere) {
  tracker_.recall(scene_, 3.0, kRoi, kNow);
  const cv::Mat other = test::tissue(kSize, 77);
  EXPECT_EQ(tracker_.track(other, kNow + 0.04).state, State::kSearching);
  EXPECT_EQ(tracker_.track(other, kNow + 3.0).state, State::kLost);
}

TEST_F(RegionTrackerRecallTest, IsIdleWhenTheImagesHaveAnotherSizeOrTimeJumpsBack) {
  tracker_.recall(scene_, 3.0, kRoi, kNow);
  EXPECT_EQ(tracker_.track(test::tissue(cv::Size(320, 240), 1), kNow + 0.04).state, State::kIdle);
  tracker_.recall(scene_, 3.0, kRoi, kNow);
  EXPECT_EQ(tracker_.track(image(0), kNow - 1.0).state, State::kIdle);
}

TEST_F(RegionTrackerRecallTest, ARegionThatIsRefusedLeavesTheTrackerAsItWas) {
  select();
  EXPECT_THROW(tracker_.recall(scene_, 0.0, {300, 80, 112, 112}, 0.0), std::invalid_argument);
  EXPECT_THROW(tracker_.recall(cv::Mat(), 0.0, kRoi, 0.0), std::invalid_argument);
  EXPECT_EQ(tracker_.track(image(1), 0.04).state, State::kTracking);
}

}  // namespace
}  // namespace laparoscope_servo::tracking
