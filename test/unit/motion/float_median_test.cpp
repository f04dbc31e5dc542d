#include "motion/float_median.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "laparoscope_servo/robust/median.h"

namespace laparoscope_servo::motion {
namespace {

TEST(FloatMedian, IsThatOfTheSortedValues) {
  std::mt19937 random(3);
  std::normal_distribution<float> normal(0.0f, 30.0f);
  for (int size = 1; size < 200; ++size) {
    std::vector<float> values;
    for (int k = 0; k < size; ++k) values.push_back(k % 5 == 4 ? values.back() : normal(random));
    std::vector<float> sorted = values;
    EXPECT_EQ(floatMedian(values), robust::median(sorted)) << size;
  }
}

TEST(FloatMedian, OfOneSignOrOfOneValue) {
  std::vector<float> negative{-3.0f, -1.0f, -2.0f}, positive{3.0f, 1.0f, 2.0f}, same(7, -0.25f), large{-3e38f, 3e38f};
  EXPECT_EQ(floatMedian(negative), -2.0f);
  EXPECT_EQ(floatMedian(positive), 2.0f);
  EXPECT_EQ(floatMedian(same), -0.25f);
  EXPECT_EQ(floatMedian(large), 3e38f);
}

}  // namespace
}  // namespace laparoscope_servo::motion
