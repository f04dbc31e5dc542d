#include "laparoscope_servo/features/feature_state.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>

namespace laparoscope_servo::features {
namespace {

TEST(FeatureState, oneImageWithoutItEndsTracking) {
  StateKeeper keeper({1.0, 2});
  EXPECT_EQ(keeper.state(), State::kIdle);
  keeper.select(10.0);
  keeper.step(Reason::kNone, 10.1);
  EXPECT_EQ(keeper.state(), State::kTracking);
  keeper.step(Reason::kTooFewSites, 10.2);
  EXPECT_EQ(keeper.state(), State::kSearching);
  EXPECT_EQ(keeper.reason(), Reason::kTooFewSites);
  EXPECT_EQ(keeper.searchingSince(), 10.2);
}

TEST(FeatureState, comesBackWhenConfirmedInARow) {
  StateKeeper keeper({1.0, 2});
  keeper.select(0.0);
  keeper.step(Reason::kChance, 0.1);
  keeper.step(Reason::kNone, 0.2);
  EXPECT_EQ(keeper.state(), State::kSearching);
  EXPECT_EQ(keeper.reason(), Reason::kNotConfirmed);
  keeper.step(Reason::kChance, 0.3);
  keeper.step(Reason::kNone, 0.4);
  EXPECT_EQ(keeper.state(), State::kSearching);
  keeper.step(Reason::kNone, 0.5);
  EXPECT_EQ(keeper.state(), State::kTracking);
  EXPECT_EQ(keeper.reason(), Reason::kNone);
}

TEST(FeatureState, isLostAfterASearchButMayComeBack) {
  StateKeeper keeper({1.0, 1});
  keeper.select(0.0);
  keeper.step(Reason::kChance, 0.1);
  keeper.step(Reason::kChance, 1.0);
  EXPECT_EQ(keeper.state(), State::kSearching);
  keeper.step(Reason::kChance, 1.2);
  EXPECT_EQ(keeper.state(), State::kLost);
  keeper.step(Reason::kNone, 1.3);
  EXPECT_EQ(keeper.state(), State::kTracking);
}

TEST(FeatureState, aStampThatIsNoNumberDoesNotKeepTheSearchAlive) {
  StateKeeper keeper({1.0, 2});
  keeper.select(0.0);
  keeper.step(Reason::kChance, std::numeric_limits<double>::quiet_NaN());
  EXPECT_EQ(keeper.state(), State::kLost);
}

TEST(FeatureState, idleStaysIdle) {
  StateKeeper keeper({1.0, 1});
  keeper.select(0.0);
  keeper.reset(Reason::kTimeJumpedBack);
  keeper.step(Reason::kNone, 1.0);
  EXPECT_EQ(keeper.state(), State::kIdle);
  EXPECT_EQ(keeper.reason(), Reason::kTimeJumpedBack);
}

TEST(FeatureState, everyReasonHasWords) {
  for (int k = 1; k <= static_cast<int>(Reason::kNothingDominates); ++k)
    EXPECT_GT(std::string(reasonText(Reason(k))).size(), 4u);
  EXPECT_STREQ(stateName(State::kSearching), "SEARCHING");
}

}  // namespace
}  // namespace laparoscope_servo::features
