#include "laparoscope_servo/tracking/region_tracker.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "region_tracker_fixture.h"

namespace laparoscope_servo::tracking {
namespace {

TEST_F(RegionTrackerTest, IsIdleUntilARegionIsSelected) {
  const TrackResult result = tracker_.track(image(0), 0.0);
  EXPECT_EQ(result.state, State::kIdle);
  EXPECT_NE(result.reason, "");
  EXPECT_FALSE(tracker_.hasRoi());
  EXPECT_TRUE(tracker_.occlusionMask().empty());
}

TEST_F(RegionTrackerTest, FollowsAMovingCamera) {
  select();
  for (int frame = 1; frame < 40; ++frame) {
    const TrackResult r = tracker_.track(image(frame), 0.04 * frame);
    ASSERT_EQ(r.state, State::kTracking) << r.reason;
    EXPECT_LT(error(r, frame), 0.3);
    EXPECT_NEAR(r.g.determinant(), 1.0, 1e-9);
    EXPECT_EQ(r.reason, "");
    EXPECT_GT(r.visible_fraction, 0.9);
    EXPECT_EQ(r.areas.distance.size(), 196u);
  }
}

TEST_F(RegionTrackerTest, BearsChangesOfLight) {
  select();
  for (int frame = 1; frame < 40; ++frame) {
    const TrackResult r = tracker_.track(image(frame, 1.0 + 0.25 * std::sin(frame / 6.0)), 0.04 * frame);
    ASSERT_EQ(r.state, State::kTracking) << r.reason;
    EXPECT_LT(error(r, frame), 0.4);
  }
}

TEST_F(RegionTrackerTest, TracksGreyImages) {
  cv::Mat mono;
  cv::cvtColor(image(0), mono, cv::COLOR_BGR2GRAY);
  tracker_.select(mono, 0.0, kRoi);
  for (int frame = 1; frame < 15; ++frame) {
    cv::cvtColor(image(frame), mono, cv::COLOR_BGR2GRAY);
    const TrackResult r = tracker_.track(mono, 0.04 * frame);
    ASSERT_EQ(r.state, State::kTracking) << r.reason;
    EXPECT_FALSE(r.colour_used);
    EXPECT_LT(error(r, frame), 0.5);
  }
}

TEST_F(RegionTrackerTest, FindsAnOccluderAndSaysWhere) {
  select();
  for (int frame = 1; frame < 12; ++frame) {
    cv::Mat seen = image(0);
    const int covered = 5 * frame;  // px from the left of the ROI
    seen(cv::Rect(0, 0, 110 + covered, kSize.height)).setTo(cv::Scalar(180, 185, 190));
    const TrackResult r = tracker_.track(seen, 0.04 * frame);
    ASSERT_EQ(r.state, State::kTracking) << r.reason;
    EXPECT_LT(error(r, 0), 0.5);
    const cv::Mat mask = tracker_.occlusionMask();
    ASSERT_EQ(mask.size(), kSize);
    EXPECT_EQ(mask.at<unsigned char>(135, 210), 0);
    EXPECT_EQ(mask.at<unsigned char>(20, 20), 0);  // outside the ROI
    if (covered > 16) {
      EXPECT_EQ(mask.at<unsigned char>(135, 115), 255);
      EXPECT_LT(r.visible_fraction, 0.92);
    }
  }
}

TEST_F(RegionTrackerTest, SaysSearchingThenLostWhenTheViewIsGoneAndComesBackConfirmed) {
  select();
  int frame = 1;
  for (; frame < 5; ++frame) ASSERT_EQ(tracker_.track(image(frame), 0.04 * frame).state, State::kTracking);
  const cv::Mat smoke(kSize, CV_8UC3, cv::Scalar(120, 120, 120));
  bool searched = false;
  for (; frame < 80; ++frame) {
    const TrackResult r = tracker_.track(smoke, 0.04 * frame);
    ASSERT_NE(r.state, State::kTracking);
    ASSERT_NE(r.reason, "");
    ASSERT_TRUE(r.g.allFinite());
    searched |= r.state == State::kSearching;
  }
  EXPECT_TRUE(searched);
  EXPECT_EQ(tracker_.track(smoke, 0.04 * frame++).state, State::kLost);
  // Back elsewhere: one good image is not enough.
  Eigen::Matrix3d elsewhere = Eigen::Matrix3d::Identity();
  elsewhere.topRightCorner<2, 1>() << 70.0, 40.0;
  TrackResult r;
  for (int k = 0; k < 12; ++k) {
    r = tracker_.track(test::view(scene_, elsewhere, 1.0, 0.0, 2.0, 50 + k), 0.04 * frame++);
    if (k == 0) {
      EXPECT_NE(r.state, State::kTracking);
    }
  }
  EXPECT_EQ(r.state, State::kTracking) << r.reason;
  EXPECT_LT(geometry::cornerDistance(r.g, elsewhere, kRoi), 0.5);
}

// It has gone on while nobody saw it, and goes on while it is being confirmed.
TEST_F(RegionTrackerTest, ComesBackWhileItIsMoving) {
  tracker_.select(test::view(scene_, Eigen::Matrix3d::Identity(), 1.0, 0.0, 2.0, 1), 0.0, kRoi);
  const cv::Mat smoke(kSize, CV_8UC3, cv::Scalar(120, 120, 120));
  const auto at = [](int frame) {
    Eigen::Matrix3d g = Eigen::Matrix3d::Identity();
    g(0, 2) = -40.0 + 9.0 * std::max(0, frame - 20);
    return g;
  };
  int frame = 1;
  for (; frame <= 20; ++frame)
    tracker_.track(test::view(scene_, Eigen::Matrix3d::Identity(), 1.0, 0.0, 2.0, frame), 0.04 * frame);
  for (; frame <= 25; ++frame) ASSERT_NE(tracker_.track(smoke, 0.04 * frame).state, State::kTracking);
  int seen = 0;
  for (; seen < 6; ++seen, ++frame) {
    const TrackResult r = tracker_.track(test::view(scene_, at(frame), 1.0, 0.0, 2.0, frame), 0.04 * frame);
    if (r.state != State::kTracking) continue;
    EXPECT_LT(geometry::cornerDistance(r.g, at(frame), kRoi), 0.5);
    break;
  }
  EXPECT_LT(seen, 6);
  EXPECT_GE(seen, 2);  // three images in a row
}

TEST_F(RegionTrackerTest, OtherTissueIsNotTakenForTheRegion) {
  select();
  const cv::Mat other = test::tissue(kSize, 77);
  for (int frame = 1; frame < 30; ++frame) {
    const TrackResult r = tracker_.track(test::view(other, motion(frame), 1.0, 0.0, 2.0, frame), 0.04 * frame);
    EXPECT_NE(r.state, State::kTracking) << frame;
  }
}

TEST_F(RegionTrackerTest, FollowsTheRegionPartlyOutOfTheImage) {
  select();
  for (int frame = 1; frame < 25; ++frame) {
    Eigen::Matrix3d g = Eigen::Matrix3d::Identity();
    g(0, 2) = -6.0 * frame;  // in the end 34 of 112 columns are outside
    const TrackResult r = tracker_.track(test::view(scene_, g, 1.0, 0.0, 2.0, frame), 0.04 * frame);
    ASSERT_EQ(r.state, State::kTracking) << frame << ": " << r.reason;
    EXPECT_LT(geometry::cornerDistance(r.g, g, kRoi), 1.0) << frame;
  }
}

// The picture of a laparoscope is round; what is black beside it stays where it is while the tissue moves.
TEST_F(RegionTrackerTest, FollowsTheRegionIntoTheRoundBorderOfThePicture) {
  cv::Mat1b picture(kSize, 0);
  cv::circle(picture, cv::Point(180, 150), 140, 255, -1);
  const auto throughTheScope = [&](const Eigen::Matrix3d& g, unsigned seed) {
    cv::Mat seen(kSize, CV_8UC3, cv::Scalar(2, 2, 2));
    test::view(scene_, g, 1.0, 0.0, 2.0, seed).copyTo(seen, picture);
    return seen;
  };
  tracker_.select(throughTheScope(Eigen::Matrix3d::Identity(), 1), 0.0, kRoi);
  TrackResult r;
  for (int frame = 1; frame < 20; ++frame) {
    Eigen::Matrix3d g = Eigen::Matrix3d::Identity();
    g(0, 2) = -4.0 * frame;
    r = tracker_.track(throughTheScope(g, 100 + frame), 0.04 * frame);
    ASSERT_EQ(r.state, State::kTracking) << frame << ": " << r.reason;
    EXPECT_LT(geometry::cornerDistance(r.g, g, kRoi), 1.0) << frame;
  }
  const cv::Rect roi(110 - 4 * 19, 80, 112, 112);
  const double in_picture = cv::countNonZero(picture(roi)) / static_cast<double>(roi.area());
  EXPECT_LT(r.visible_fraction, in_picture + 0.02);
  EXPECT_GT(r.visible_fraction, in_picture - 0.1);
  EXPECT_TRUE(r.areas.occluded[0]);  // its upper left corner is beside the picture
}

TEST_F(RegionTrackerTest, TheSameImagesGiveTheSameNumbers) {
  RegionTracker other{TrackerConfig()};
  select();
  other.select(test::view(scene_, motion(0), 1.0, 0.0, 2.0), 0.0, kRoi);
  for (int frame = 1; frame < 8; ++frame) {
    const TrackResult a = tracker_.track(image(frame), 0.04 * frame);
    const TrackResult b = other.track(image(frame), 0.04 * frame);
    EXPECT_EQ((a.g - b.g).norm(), 0.0);
    EXPECT_EQ(a.zncc, b.zncc);
    EXPECT_EQ(a.iterations, b.iterations);
  }
}

TEST_F(RegionTrackerTest, ResetForgetsTheRegion) {
  select();
  tracker_.reset();
  EXPECT_FALSE(tracker_.hasRoi());
  EXPECT_EQ(tracker_.track(image(1), 0.04).state, State::kIdle);
  select();
}

// The paper's detector as published, without the structure gate: a still target, a sheet that moves in front.
TEST_F(RegionTrackerTest, ThePublishedDetectorHoldsAStillTargetBehindAMovingSheet) {
  TrackerConfig config;
  config.occlusion.structure = false;
  config.occlusion.colour = ColourGate::kPublished;
  RegionTracker with(config);
  config.occlusion.colour = ColourGate::kNone;
  RegionTracker without(config);
  with.select(image(0), 0.0, kRoi);
  without.select(image(0), 0.0, kRoi);
  int lost_without = 0;
  for (int frame = 1; frame < 20; ++frame) {
    cv::Mat seen = test::view(scene_, motion(0), 1.0, 0.0, 2.0, frame);
    seen(cv::Rect(0, 0, 110 + 4 * frame, kSize.height)).setTo(cv::Scalar(180, 185, 190));
    const TrackResult r = with.track(seen, 0.04 * frame);
    ASSERT_EQ(r.state, State::kTracking) << frame << ": " << r.reason;
    EXPECT_LT(error(r, 0), 1.0) << frame;
    lost_without += without.track(seen, 0.04 * frame).state != State::kTracking;
  }
  EXPECT_GT(lost_without, 0);
}

TEST_F(RegionTrackerTest, ProposesARegionThatItTakesWhereOneIsRefused) {
  cv::Mat image(kSize, CV_8UC3, cv::Scalar(70, 80, 150));
  const cv::Rect textured(200, 60, 120, 120);
  scene_(textured).copyTo(image(textured));
  const geometry::Rectangle smooth = {90, 80, 80, 80};
  EXPECT_THROW(tracker_.select(image, 0.0, smooth), std::invalid_argument);
  const auto proposal = tracker_.propose(image, smooth);
  ASSERT_TRUE(proposal);
  EXPECT_NO_THROW(tracker_.check(image, *proposal));
  EXPECT_FALSE(tracker_.hasRoi());
  EXPECT_EQ(tracker_.select(image, 0.0, *proposal).state, State::kTracking);
}

TEST_F(RegionTrackerTest, ProposesALargerRegionForOneThatIsTooSmall) {
  const auto proposal = tracker_.propose(scene_, {100, 100, 4, 4});
  ASSERT_TRUE(proposal);
  EXPECT_GE(proposal->width, tracker_.config().min_roi_side);
  EXPECT_NO_THROW(tracker_.check(scene_, *proposal));
}

TEST_F(RegionTrackerTest, ProposesNothingWithoutARegionOrAnImage) {
  EXPECT_THROW(tracker_.propose(cv::Mat(), kRoi), std::invalid_argument);
  EXPECT_THROW(tracker_.propose(scene_, {10, 10, 0, 50}), std::invalid_argument);
  EXPECT_THROW(tracker_.propose(scene_, {std::nan(""), 10, 50, 50}), std::invalid_argument);
  EXPECT_FALSE(tracker_.propose(cv::Mat(kSize, CV_8UC3, cv::Scalar(70, 80, 150)), kRoi));
}

}  // namespace
}  // namespace laparoscope_servo::tracking
