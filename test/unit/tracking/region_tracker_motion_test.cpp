// The tracker with a robot that says how the camera has moved.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "laparoscope_servo/tracking/region_tracker.h"
#include "support/synthetic_tissue.h"

namespace laparoscope_servo::tracking {
namespace {

const geometry::Rectangle kRoi = {270, 190, 100, 100};
const geometry::PinholeCamera kCamera = {400.0, 400.0, 319.5, 239.5};
constexpr double kDepth = 0.08;  // m

Eigen::Isometry3d pose(double x, double y, double z, double turn) {
  Eigen::Isometry3d tissue_T_camera = Eigen::Isometry3d::Identity();
  tissue_T_camera.linear() = Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  tissue_T_camera.translation() << x, y, z;
  return tissue_T_camera;
}

// A camera that jumps by about 90 px an image, now here, now there, in front of a plane at z = kDepth.
Eigen::Isometry3d jerky(int frame) {
  if (frame == 0) return pose(0.0, 0.0, 0.0, 0.0);
  cv::RNG rng(77 + frame);
  const double side = frame % 2 == 0 ? 1.0 : -1.0;
  return pose(side * rng.uniform(0.006, 0.010), rng.uniform(-0.008, 0.008), rng.uniform(-0.004, 0.004),
              rng.uniform(-0.2, 0.2));
}

Eigen::Matrix3d truth(int frame) {
  return geometry::pixelsFromPlane(jerky(frame).inverse(), Eigen::Vector3d::UnitZ(), kDepth, kCamera);
}

// From the image before to this one, by poses that are a little off, a depth that is 3 % off, and a plane that is taken
// to be parallel to the image.
Eigen::Matrix3d byRobot(int from, int to) {
  Eigen::Isometry3d motion = jerky(to).inverse() * jerky(from);
  motion.translation() += Eigen::Vector3d(0.0003, -0.0003, 0.0002);
  return geometry::pixelsFromPlane(motion, Eigen::Vector3d::UnitZ(), 1.03 * kDepth, kCamera);
}

class RegionTrackerMotion : public ::testing::Test {
 protected:
  void SetUp() override {
    // What is searched for afterwards is another matter.
    TrackerConfig config;
    config.search.features = config.search.correlation = false;
    tracker_ = RegionTracker(config);
    ASSERT_EQ(tracker_.select(image(0), 0.0, kRoi).state, State::kTracking);
  }
  cv::Mat image(int frame) const { return test::view(scene_, truth(frame), 1.0, 0.0, 2.0, 100 + frame); }

  const cv::Mat scene_ = test::tissue(cv::Size(640, 480), 5);
  RegionTracker tracker_{TrackerConfig()};
};

TEST_F(RegionTrackerMotion, LosesWithoutItWhatJumpsTooFar) {
  int tracked = 0;
  for (int frame = 1; frame <= 8; ++frame)
    tracked += tracker_.track(image(frame), 0.04 * frame).state == State::kTracking ? 1 : 0;
  EXPECT_LE(tracked, 1);
}

TEST_F(RegionTrackerMotion, FollowsWithIt) {
  for (int frame = 1; frame <= 16; ++frame) {
    const TrackResult r = tracker_.track(image(frame), 0.04 * frame, byRobot(frame - 1, frame));
    ASSERT_EQ(r.state, State::kTracking) << frame << ": " << r.reason;
    EXPECT_TRUE(r.motion_used);
    EXPECT_LT(geometry::cornerDistance(r.g, truth(frame), kRoi), 0.3) << frame;
  }
}

TEST_F(RegionTrackerMotion, AnyScaleWillDo) {
  for (int frame = 1; frame <= 4; ++frame) {
    const TrackResult r = tracker_.track(image(frame), 0.04 * frame, Eigen::Matrix3d(7.0 * byRobot(frame - 1, frame)));
    ASSERT_EQ(r.state, State::kTracking) << frame << ": " << r.reason;
    EXPECT_TRUE(r.motion_used);
  }
}

TEST_F(RegionTrackerMotion, GoesOnWhenItIsMissingForAWhile) {
  // The camera jumps, rests, and rests while the robot is silent.
  for (int frame = 1; frame <= 16; ++frame) {
    const int at = frame / 4;
    std::optional<Eigen::Matrix3d> motion;
    if (frame % 4 == 0) motion = byRobot(at - 1, at);
    if (frame % 4 == 1) motion = Eigen::Matrix3d::Identity();
    const TrackResult r = tracker_.track(image(at), 0.04 * frame, motion);
    ASSERT_EQ(r.state, State::kTracking) << frame << ": " << r.reason;
    EXPECT_EQ(r.motion_used, motion.has_value());
    EXPECT_LT(geometry::cornerDistance(r.g, truth(at), kRoi), 0.3) << frame;
  }
}

TEST_F(RegionTrackerMotion, WhatIsNoMotionIsIgnored) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Eigen::Matrix3d mirrored = Eigen::Matrix3d::Identity(), huge = mirrored, through_infinity = mirrored,
                  one_nan = mirrored;
  mirrored(0, 0) = -1.0;
  huge(0, 0) = huge(1, 1) = 1e9;
  through_infinity(2, 0) = -1.0 / 320.0;
  one_nan(1, 2) = nan;
  int frame = 1;
  for (const Eigen::Matrix3d& bad :
       {Eigen::Matrix3d(Eigen::Matrix3d::Constant(nan)), Eigen::Matrix3d(Eigen::Matrix3d::Zero()), mirrored, huge,
        through_infinity, one_nan, Eigen::Matrix3d(Eigen::Matrix3d::Constant(1e308))}) {
    const TrackResult r = tracker_.track(image(0), 0.04 * frame, bad);
    ASSERT_EQ(r.state, State::kTracking) << bad << '\n' << r.reason;
    EXPECT_FALSE(r.motion_used);
    EXPECT_LT(geometry::cornerDistance(r.g, truth(0), kRoi), 0.3);
    ++frame;
  }
}

TEST_F(RegionTrackerMotion, WhatLeadsNowhereDoesNoHarm) {
  for (const Eigen::Vector2d& shift :
       {Eigen::Vector2d(150.0, 0.0), Eigen::Vector2d(-90.0, 130.0), Eigen::Vector2d(5000.0, 0.0)}) {
    ASSERT_EQ(tracker_.select(image(0), 0.0, kRoi).state, State::kTracking);
    Eigen::Matrix3d wrong = Eigen::Matrix3d::Identity();
    wrong.topRightCorner<2, 1>() = shift;
    for (int frame = 1; frame <= 4; ++frame) {
      const TrackResult r = tracker_.track(image(0), 0.04 * frame, wrong);
      ASSERT_EQ(r.state, State::kTracking) << frame << ": " << r.reason;
      EXPECT_FALSE(r.motion_used);
      EXPECT_LT(geometry::cornerDistance(r.g, truth(0), kRoi), 0.3) << frame;
    }
  }
}

TEST_F(RegionTrackerMotion, SaysWhereToLookForWhatIsLost) {
  const cv::Mat smoke(scene_.size(), CV_8UC3, cv::Scalar(120, 120, 120));
  ASSERT_EQ(tracker_.track(smoke, 0.04, byRobot(0, 0)).state, State::kSearching);
  TrackResult r;
  for (int frame = 2; frame <= 6; ++frame) r = tracker_.track(image(1), 0.04 * frame, byRobot(0, 1));
  ASSERT_EQ(r.state, State::kTracking) << r.reason;
  EXPECT_LT(geometry::cornerDistance(r.g, truth(1), kRoi), 0.3);
}

}  // namespace
}  // namespace laparoscope_servo::tracking
