#include "laparoscope_servo/robust/draws.h"

#include <gtest/gtest.h>

#include <array>

namespace laparoscope_servo::robust {
namespace {

TEST(Draws, GivesTheSameNumbersEachTime) {
  Draws a, b;
  bool differ = false;
  std::size_t last = a.below(1000);
  EXPECT_EQ(b.below(1000), last);
  for (int k = 0; k < 100; ++k) {
    const std::size_t next = a.below(1000);
    EXPECT_EQ(b.below(1000), next);
    differ = differ || next != last;
    last = next;
  }
  EXPECT_TRUE(differ);
}

// MMIX's generator from 1: the upper 31 bits of 6364136223846793005 + 1442695040888963407.
TEST(Draws, BeginsWithTheGeneratorsFirstNumber) {
  Draws draws;
  EXPECT_EQ(draws.below(std::size_t{1} << 31), 908834774u);
}

// By chance alone a bin of 10,000 draws has 1,000 +- 30.
TEST(Draws, AreEvenlySpread) {
  Draws draws;
  std::array<int, 10> bins{};
  for (int k = 0; k < 10000; ++k) ++bins.at(draws.below(bins.size()));
  for (const int count : bins) EXPECT_NEAR(count, 1000, 150);
}

TEST(Draws, OfOneThereIsOne) {
  Draws draws;
  for (int k = 0; k < 5; ++k) EXPECT_EQ(draws.below(1), 0u);
}

}  // namespace
}  // namespace laparoscope_servo::robust
