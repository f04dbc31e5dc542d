#include "laparoscope_servo/robust/median.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>
#include <vector>

namespace laparoscope_servo::robust {
namespace {

TEST(Median, hasAsManyBelowAsAbove) {
  std::vector<double> one{3.0}, two{5.0, 1.0}, three{9.0, -1.0, 4.0};
  EXPECT_EQ(median(one), 3.0);
  EXPECT_EQ(median(two), 5.0);
  EXPECT_EQ(median(three), 4.0);
  std::mt19937 random(1);
  std::vector<float> many(101);
  for (int k = 0; k < 101; ++k) many[static_cast<std::size_t>(k)] = static_cast<float>(k);
  std::shuffle(many.begin(), many.end(), random);
  EXPECT_EQ(median(many), 50.0f);
}

// What a share of less than a half does, it does not follow.
TEST(Median, staysAmongTheMost) {
  std::vector<double> values{1.0, 1.1, 0.9, 1e9, -1e9};
  EXPECT_NEAR(median(values), 1.0, 0.1);
}

TEST(NearestRank, isTheSmallestThatTheShareDoesNotExceed) {
  std::vector<double> four{40.0, 10.0, 30.0, 20.0};
  EXPECT_EQ(nearestRank(four, 0.0), 10.0);
  EXPECT_EQ(nearestRank(four, 0.25), 10.0);
  EXPECT_EQ(nearestRank(four, 0.26), 20.0);
  EXPECT_EQ(nearestRank(four, 0.5), 20.0);
  EXPECT_EQ(nearestRank(four, 1.0), 40.0);
  std::vector<double> one{7.0};
  for (const double share : {0.0, 0.5, 1.0}) EXPECT_EQ(nearestRank(one, share), 7.0);
  std::vector<double> hundred(100);
  for (int k = 0; k < 100; ++k) hundred[static_cast<std::size_t>(k)] = 100.0 - k;
  EXPECT_EQ(nearestRank(hundred, 0.99), 99.0);
}

// No sum of infinities: what never comes has a rank all the same.
TEST(NearestRank, takesInfinity) {
  std::vector<double> values{std::numeric_limits<double>::infinity(), 1.0, 2.0};
  EXPECT_EQ(nearestRank(values, 0.5), 2.0);
  EXPECT_EQ(nearestRank(values, 1.0), std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace laparoscope_servo::robust
