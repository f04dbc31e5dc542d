#include "laparoscope_servo/tracking/track_result.h"

#include <gtest/gtest.h>

namespace laparoscope_servo::tracking {
namespace {

TEST(StateName, IsThatOfTheMessage) {
  EXPECT_STREQ(stateName(State::kIdle), "IDLE");
  EXPECT_STREQ(stateName(State::kTracking), "TRACKING");
  EXPECT_STREQ(stateName(State::kSearching), "SEARCHING");
  EXPECT_STREQ(stateName(State::kLost), "LOST");
}

TEST(TrackResult, SaysNothingBeforeTheFirstImage) {
  const TrackResult result;
  EXPECT_EQ(result.state, State::kIdle);
  EXPECT_TRUE(result.g.isIdentity());
  EXPECT_TRUE(result.areas.occluded.empty());
  EXPECT_EQ(result.visible_fraction, 0.0);
}

}  // namespace
}  // namespace laparoscope_servo::tracking
