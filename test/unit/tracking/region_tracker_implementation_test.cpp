// How the tracker's stages follow each other, image by image: what ends TRACKING, what begins it again, and what is
// reported in between. That it tracks: region_tracker_test.cpp.
#include "unit/tracking/region_tracker_fixture.h"

namespace laparoscope_servo::tracking {
namespace {

class RegionTrackerStages : public RegionTrackerTest {
 protected:
  // The next image, every 40 ms.
  TrackResult see(const cv::Mat& picture) { return tracker_.track(picture, 0.04 * ++frame_); }
  cv::Mat tissueAgain() const { return test::view(scene_, motion(0), 1.0, 0.0, 2.0, 2000 + frame_); }
  cv::Mat smoke() const { return cv::Mat(kSize, CV_8UC3, cv::Scalar(120, 120, 120)); }

  int frame_ = 0;
};

TEST_F(RegionTrackerStages, ASelectionIsKnownAsWellAsItsCorners) {
  const TrackResult r = tracker_.select(tissueAgain(), 0.0, kRoi);
  EXPECT_TRUE(r.selected_now);
  EXPECT_TRUE(r.g.isIdentity(1e-12));
  EXPECT_EQ(r.zncc, 1.0);
  EXPECT_GT(r.visible_fraction, 0.95);
  EXPECT_GT(r.corner_error, 0.0);
  EXPECT_EQ(r.centre_error, r.corner_error);
  EXPECT_FALSE(see(tissueAgain()).selected_now);
}

// Three images in a row, of which the first two say what they wait for, and where it is meanwhile.
TEST_F(RegionTrackerStages, WhatIsFoundAgainIsShownBeforeItIsBelieved) {
  select();
  for (int k = 0; k < 5; ++k) see(tissueAgain());
  EXPECT_EQ(see(smoke()).state, State::kSearching);
  const int confirmations = TrackerConfig().quality.confirmations;
  for (int k = 1; k < confirmations; ++k) {
    const TrackResult r = see(tissueAgain());
    EXPECT_EQ(r.state, State::kSearching) << k;
    EXPECT_EQ(r.reason, "found, waits for confirmation") << k;
    EXPECT_LT(error(r, 0), 0.5) << k;
    EXPECT_FALSE(r.motion_used) << "nobody told of one";
  }
  const TrackResult r = see(tissueAgain());
  EXPECT_EQ(r.state, State::kTracking) << r.reason;
  EXPECT_EQ(r.reason, "");
}

// One image without it is forgiven to a region whose blocks recognise it. After more than 0.2 s it begins anew.
TEST_F(RegionTrackerStages, ATimeWithoutItBeginsTheConfirmationAnew) {
  for (const int without : {1, 6}) {
    select();
    for (int k = 0; k < 5; ++k) see(tissueAgain());
    see(smoke());
    const int confirmations = TrackerConfig().quality.confirmations;
    for (int k = 1; k < confirmations; ++k) ASSERT_EQ(see(tissueAgain()).reason, "found, waits for confirmation");
    for (int k = 0; k < without; ++k) {
      const TrackResult lost = see(smoke());
      EXPECT_EQ(lost.state, State::kSearching);
      EXPECT_NE(lost.reason, "found, waits for confirmation");
    }
    const int missing = without == 1 ? 1 : confirmations;
    for (int k = 1; k < missing; ++k) EXPECT_EQ(see(tissueAgain()).state, State::kSearching) << without << " " << k;
    EXPECT_EQ(see(tissueAgain()).state, State::kTracking) << without;
  }
}

// By the time since the region was seen last, however many images there were; and it is searched on.
TEST_F(RegionTrackerStages, LostIsATimeWithoutIt) {
  for (const double period : {0.04, 0.5}) {
    RegionTracker tracker{TrackerConfig()};
    tracker.select(tissueAgain(), 10.0, kRoi);
    const double limit = TrackerConfig().quality.max_search_time;
    for (double t = period; t < limit + 2.0 * period; t += period) {
      if (std::abs(t - limit) < 1e-6) continue;
      const State state = tracker.track(smoke(), 10.0 + t).state;
      EXPECT_EQ(state, t > limit ? State::kLost : State::kSearching) << period << ": " << t;
    }
    TrackResult r;
    for (int k = 1; k <= 3; ++k) r = tracker.track(tissueAgain(), 20.0 + 0.04 * k);
    EXPECT_EQ(r.state, State::kTracking) << r.reason;
  }
}

// What does not go on as the images before is no image of the region: it is forgotten, with the reason, once.
TEST_F(RegionTrackerStages, AnotherSequenceEndsIt) {
  select();
  see(tissueAgain());
  EXPECT_EQ(tracker_.track(tissueAgain(), 0.04).state, State::kTracking) << "the same time again is none back";
  const TrackResult back = tracker_.track(tissueAgain(), 0.01);
  EXPECT_EQ(back.state, State::kIdle);
  EXPECT_EQ(back.reason, "time jumped back by 0.03 s");
  EXPECT_FALSE(tracker_.hasRoi());
  EXPECT_EQ(tracker_.track(tissueAgain(), 0.05).reason, "no region of interest selected");
}

// An image that cannot be used is refused before anything has changed.
TEST_F(RegionTrackerStages, AStampThatIsNoNumberChangesNothing) {
  select();
  see(tissueAgain());
  EXPECT_THROW(tracker_.track(tissueAgain(), std::nan("")), std::invalid_argument);
  EXPECT_THROW(tracker_.select(tissueAgain(), std::nan(""), kRoi), std::invalid_argument);
  EXPECT_THROW(tracker_.recall(tissueAgain(), 0.0, kRoi, std::nan("")), std::invalid_argument);
  EXPECT_EQ(see(tissueAgain()).state, State::kTracking);
}

// A motion that was told and led to the estimate is reported, and one without which it was found is not.
TEST_F(RegionTrackerStages, SaysWhetherTheToldMotionWasUsed) {
  select();
  see(tissueAgain());
  const auto told = [&](const Eigen::Matrix3d& step) { return tracker_.track(tissueAgain(), 0.04 * ++frame_, step); };
  EXPECT_TRUE(told(Eigen::Matrix3d::Identity()).motion_used);
  Eigen::Matrix3d wrong = Eigen::Matrix3d::Identity();
  wrong(0, 2) = 150.0;
  const TrackResult r = told(wrong);
  EXPECT_EQ(r.state, State::kTracking) << r.reason;
  EXPECT_FALSE(r.motion_used);
  EXPECT_LT(error(r, 0), 0.5);
}

}  // namespace
}  // namespace laparoscope_servo::tracking
