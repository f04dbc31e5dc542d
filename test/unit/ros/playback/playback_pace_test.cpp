#include "ros/playback/playback_pace.h"

#include <gtest/gtest.h>

#include <cmath>

namespace laparoscope_servo {
namespace {

using std::chrono::milliseconds;

const PlaybackPace::Clock::time_point kNow = PlaybackPace::Clock::time_point() + std::chrono::hours(100);
const ros::Time kBegin(1500000000, 250000000);

PlaybackPace paced(double speed) {
  PlaybackPace pace(speed);
  pace.begin(kBegin, kNow);
  return pace;
}

TEST(PlaybackPace, WhatComesLaterIsDueLaterByTheSpeed) {
  EXPECT_EQ(paced(1.0).due(kBegin), kNow);
  EXPECT_EQ(paced(1.0).due(kBegin + ros::Duration(0.5)), kNow + milliseconds(500));
  EXPECT_EQ(paced(2.0).due(kBegin + ros::Duration(0.5)), kNow + milliseconds(250));
  EXPECT_EQ(paced(0.25).due(kBegin + ros::Duration(0.5)), kNow + milliseconds(2000));
  EXPECT_EQ(paced(2.0).due(kBegin - ros::Duration(0.5)), kNow - milliseconds(250)) << "it was due before";
}

// On /clock time goes on between the images, and never past the one that is to come.
TEST(PlaybackPace, TheTimeOfAMomentIsTheInverse) {
  for (const double speed : {0.01, 0.5, 1.0, 3.0, 100.0}) {
    const PlaybackPace pace = paced(speed);
    for (const double seconds : {0.0, 0.001, 0.04, 1.0 / 3.0, 3600.0}) {
      const ros::Time time = kBegin + ros::Duration(seconds);
      EXPECT_NEAR((pace.at(pace.due(time)) - time).toSec(), 0.0, 1e-9 * (1.0 + speed)) << speed << ' ' << seconds;
      EXPECT_LE(pace.at(pace.due(time)), time + ros::Duration(0, 1)) << speed << ' ' << seconds;
    }
    EXPECT_NEAR((pace.at(kNow + milliseconds(100)) - kBegin).toSec(), 0.1 * speed, 1e-8);
  }
}

// After a delay images keep their distance; after a pause they begin anew.
TEST(PlaybackPace, MayBeLateAndBeginAnew) {
  PlaybackPace pace = paced(2.0);
  const ros::Time time = kBegin + ros::Duration(1.0);
  pace.delay(milliseconds(70));
  EXPECT_EQ(pace.due(time), kNow + milliseconds(570));
  pace.delay(milliseconds(30));
  EXPECT_EQ(pace.due(time), kNow + milliseconds(600));
  pace.begin(time, kNow + milliseconds(5000));
  EXPECT_EQ(pace.due(time), kNow + milliseconds(5000));
  EXPECT_EQ(pace.due(time + ros::Duration(1.0)), kNow + milliseconds(5500));
}

}  // namespace
}  // namespace laparoscope_servo
