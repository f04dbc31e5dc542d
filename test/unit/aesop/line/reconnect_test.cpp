#include "laparoscope_servo/aesop/reconnect.h"

#include <gtest/gtest.h>

#include <limits>

namespace laparoscope_servo::aesop {
namespace {

TEST(Reconnect, theFirstAttemptIsDueAtOnce) {
  const Reconnect reconnect{ReconnectConfig()};
  EXPECT_TRUE(reconnect.due(1000.0));
  EXPECT_EQ(reconnect.remaining(1000.0), 0.0);
}

TEST(Reconnect, pausesDoubleUpToTheLongest) {
  Reconnect reconnect{ReconnectConfig()};
  double now = 100.0;
  for (const double pause : {0.5, 1.0, 2.0, 4.0, 8.0, 8.0, 8.0}) {
    reconnect.lost(now);
    EXPECT_NEAR(reconnect.remaining(now), pause, 1e-9);
    EXPECT_FALSE(reconnect.due(now + pause - 0.001));
    EXPECT_TRUE(reconnect.due(now + pause + 0.001));
    now += pause + 0.1;
  }
}

TEST(Reconnect, onlyALinkThatLastedMakesThemShortAgain) {
  Reconnect reconnect{ReconnectConfig()};
  reconnect.lost(0.0);
  reconnect.up(1.0);
  reconnect.up(5.9);
  reconnect.lost(5.9);
  EXPECT_NEAR(reconnect.remaining(5.9), 1.0, 1e-9) << "a loose cable";
  reconnect.up(7.0);
  reconnect.up(12.1);
  reconnect.lost(12.1);
  EXPECT_NEAR(reconnect.remaining(12.1), 0.5, 1e-9);
}

// The time between two short sessions is not one of them.
TEST(Reconnect, timeWithoutALinkDoesNotCount) {
  Reconnect reconnect{ReconnectConfig()};
  reconnect.up(0.0);
  reconnect.lost(1.0);
  reconnect.lost(100.0);
  EXPECT_NEAR(reconnect.remaining(100.0), 1.0, 1e-9);
}

TEST(ReconnectConfig, everyFieldIsChecked) {
  EXPECT_TRUE(validate(ReconnectConfig()).empty());
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (double ReconnectConfig::*field :
       {&ReconnectConfig::first_pause, &ReconnectConfig::longest_pause, &ReconnectConfig::stable_time}) {
    for (const double value : {nan, -1.0, 1e9}) {
      ReconnectConfig config;
      config.*field = value;
      EXPECT_FALSE(validate(config).empty()) << value;
    }
  }
  ReconnectConfig config;
  config.longest_pause = 0.4;
  ASSERT_EQ(validate(config).size(), 1u) << "shorter than the first";
  EXPECT_NE(validate(config)[0].find("longest_pause = 0.4"), std::string::npos) << validate(config)[0];
}

}  // namespace
}  // namespace laparoscope_servo::aesop
