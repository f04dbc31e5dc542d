#include "laparoscope_servo/robust/mad.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace laparoscope_servo::robust {
namespace {

TEST(Mad, isTheStandardDeviationOfNormalNoise) {
  std::mt19937 random(3);
  std::normal_distribution<double> noise(5.0, 2.0);
  std::vector<double> values;
  for (int k = 0; k < 20000; ++k) values.push_back(noise(random));
  const Spread found = spread(values);
  EXPECT_NEAR(found.centre, 5.0, 0.05);
  EXPECT_NEAR(found.sigma, 2.0, 0.05);
}

// Two fifths of the values astray move it by what the order of the others moves, not by how far they are.
TEST(Mad, doesNotFollowWhatIsAstray) {
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0.0, 1.0);
  std::vector<double> near, far;
  for (int k = 0; k < 1000; ++k) {
    const double value = noise(random);
    near.push_back(k % 5 < 2 ? 1e3 : value);
    far.push_back(k % 5 < 2 ? 1e9 : value);
  }
  const Spread found = spread(near), further = spread(far);
  EXPECT_EQ(found.centre, further.centre);
  EXPECT_EQ(found.sigma, further.sigma);
  EXPECT_LT(found.sigma, 4.0);
}

TEST(Mad, scalesAndShiftsWithTheValues) {
  std::vector<float> values{1.0f, 2.0f, 4.0f, 8.0f, 16.0f}, moved{-3.0f, -5.0f, -9.0f, -17.0f, -33.0f};  // -1 - 2 v
  const Spread found = spread(values), of_moved = spread(moved);
  EXPECT_DOUBLE_EQ(of_moved.centre, -1.0 - 2.0 * found.centre);
  EXPECT_DOUBLE_EQ(of_moved.sigma, 2.0 * found.sigma);
}

TEST(Mad, ofOneValueIsZero) {
  std::vector<double> one{7.0};
  const Spread found = spread(one);
  EXPECT_EQ(found.centre, 7.0);
  EXPECT_EQ(found.sigma, 0.0);
}

}  // namespace
}  // namespace laparoscope_servo::robust
