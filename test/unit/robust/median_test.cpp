#include "laparoscope_servo/robust/median.h"

#include <gtest/gtest.h>

#include <random>

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

}  // namespace
}  // namespace laparoscope_servo::robust
