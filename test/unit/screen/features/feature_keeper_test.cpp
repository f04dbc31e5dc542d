#include "screen/features/feature_keeper.h"

#include <gtest/gtest.h>

#include <limits>

namespace laparoscope_servo::screen {
namespace {

std::shared_ptr<const FeatureResult> result(std::int64_t stamp) {
  auto result = std::make_shared<FeatureResult>();
  result->stamp = stamp;
  return result;
}

TEST(FeatureKeeper, FindsTheResultOfThePicturesOwnImage) {
  FeatureKeeper keeper;
  for (const std::int64_t stamp : {100, 200, 300}) keeper.take("edges", result(stamp), 1.0);
  keeper.match(200);
  ASSERT_EQ(keeper.facts().size(), 1u);
  EXPECT_EQ(keeper.facts()[0].drawn->stamp, 200);
  EXPECT_EQ(keeper.facts()[0].newest->stamp, 300);
  EXPECT_EQ(keeper.facts()[0].heard_at, 1.0);
}

TEST(FeatureKeeper, TakesTheNewestBeforeItUntilItsOwnComes) {
  FeatureKeeper keeper;
  keeper.take("edges", result(100), 1.0);
  keeper.match(250);
  EXPECT_EQ(keeper.facts()[0].drawn->stamp, 100);
  keeper.take("edges", result(250), 1.0);
  EXPECT_EQ(keeper.facts()[0].drawn->stamp, 250);
  keeper.take("edges", result(300), 1.0);
  EXPECT_EQ(keeper.facts()[0].drawn->stamp, 250) << "of an image that is not shown yet";
}

// A film that begins anew.
TEST(FeatureKeeper, HasNothingOfALaterTime) {
  FeatureKeeper keeper;
  for (const std::int64_t stamp : {900, 1000}) keeper.take("edges", result(stamp), 1.0);
  keeper.match(100);
  EXPECT_EQ(keeper.facts()[0].drawn, nullptr);
  keeper.take("edges", result(100), 2.0);
  EXPECT_EQ(keeper.facts()[0].drawn->stamp, 100);
}

TEST(FeatureKeeper, KeepsTrackersApartAndTheirNumberOfResultsSmall) {
  FeatureKeeper keeper;
  keeper.setConnected("instrument", true);
  for (std::int64_t stamp = 1; stamp <= 1000; ++stamp) keeper.take("edges", result(stamp), 1.0);
  keeper.match(500);
  const std::vector<FeatureTrackerFacts> facts = keeper.facts();
  ASSERT_EQ(facts.size(), 2u);
  EXPECT_EQ(facts[0].name, "edges");
  EXPECT_FALSE(facts[0].connected);
  EXPECT_EQ(facts[0].drawn, nullptr) << "it is long since forgotten";
  EXPECT_EQ(facts[1].name, "instrument");
  EXPECT_TRUE(facts[1].connected);
  EXPECT_LT(facts[1].heard_at, 0.0);
  EXPECT_EQ(facts[1].newest, nullptr);
}

}  // namespace
}  // namespace laparoscope_servo::screen
