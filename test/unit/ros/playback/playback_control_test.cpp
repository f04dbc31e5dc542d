#include "ros/playback/playback_control.h"

#include <gtest/gtest.h>

#include <limits>

namespace laparoscope_servo {
namespace {

using State = PlaybackControl::State;

TEST(PlaybackControl, HoldsAtTheFirstImageUntilARegionIsSelected) {
  PlaybackControl control;
  EXPECT_FALSE(control.takeImage()) << "it waits";
  EXPECT_NE(control.command("PLAY", 0.0), "");
  control.begin(true);
  EXPECT_EQ(control.state(), State::kHolding);
  EXPECT_TRUE(control.takeImage());
  EXPECT_FALSE(control.takeImage());
  control.releaseHold();
  EXPECT_EQ(control.state(), State::kPlaying);
  EXPECT_TRUE(control.takeImage() && control.takeImage());
}

TEST(PlaybackControl, PausesStepsAndPlaysOn) {
  PlaybackControl control;
  control.begin(false);
  EXPECT_EQ(control.command("PAUSE", 0.0), "");
  EXPECT_FALSE(control.takeImage());
  control.releaseHold();
  EXPECT_EQ(control.state(), State::kPaused) << "a region does not end a pause";
  EXPECT_EQ(control.command("STEP", 0.0), "");
  EXPECT_TRUE(control.takeImage());
  EXPECT_FALSE(control.takeImage());
  EXPECT_EQ(control.command("PLAY", 0.0), "");
  EXPECT_TRUE(control.takeImage());
}

TEST(PlaybackControl, WhatCannotBeReadIsTriedAgain) {
  PlaybackControl control;
  control.fail();  // it could not be opened
  EXPECT_FALSE(control.hasBegun());
  EXPECT_STREQ(control.stateName(), "FAILED");
  EXPECT_FALSE(control.takeImage());
  for (const char* command : {"PLAY", "PAUSE", "STEP"})
    EXPECT_NE(control.command(command, 0.0).find("cannot be read"), std::string::npos) << command;
  EXPECT_EQ(control.command("AGAIN", 0.0), "");
  EXPECT_EQ(control.takeSeek(), 0.0);
  control.begin(true);
  EXPECT_EQ(control.state(), State::kHolding) << "it has not begun before";
  EXPECT_TRUE(control.hasBegun());
  EXPECT_TRUE(control.takeImage());
  EXPECT_FALSE(control.takeImage());
  EXPECT_EQ(control.command("PLAY", 0.0), "");
  control.fail();  // further on
  EXPECT_EQ(control.command("SEEK", 2.0), "");
  control.begin(true);
  EXPECT_EQ(control.state(), State::kPaused) << "it had begun";
  EXPECT_EQ(control.takeSeek(), 2.0);
  EXPECT_TRUE(control.takeImage());
}

TEST(PlaybackControl, SeeksAndBeginsAgain) {
  PlaybackControl control;
  control.begin(false);
  EXPECT_EQ(control.command("SEEK", 3.5), "");
  EXPECT_FALSE(control.takeImage()) << "first to the place";
  EXPECT_EQ(control.takeSeek(), 3.5);
  EXPECT_FALSE(control.takeSeek());
  EXPECT_TRUE(control.takeImage());
  control.end();
  EXPECT_STREQ(control.stateName(), "ENDED");
  EXPECT_NE(control.command("PLAY", 0.0), "");
  EXPECT_NE(control.command("STEP", 0.0), "");
  EXPECT_EQ(control.command("SEEK", 1.0), "");
  EXPECT_EQ(control.state(), State::kPaused);
  control.takeSeek();
  EXPECT_TRUE(control.takeImage()) << "the image there is shown";
  EXPECT_FALSE(control.takeImage());
  EXPECT_EQ(control.command("AGAIN", 0.0), "");
  EXPECT_EQ(control.takeSeek(), 0.0);
  EXPECT_TRUE(control.takeImage());
}

TEST(PlaybackControl, RefusesWhatItDoesNotUnderstand) {
  PlaybackControl control;
  control.begin(false);
  EXPECT_NE(control.command("BACK", 0.0).find("'BACK'"), std::string::npos);
  for (const double position :
       {-1.0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()})
    EXPECT_NE(control.command("SEEK", position), "");
  EXPECT_FALSE(control.takeSeek());
  EXPECT_TRUE(control.takeImage());
}

}  // namespace
}  // namespace laparoscope_servo
