#include "ros/playback/natural_order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <string>
#include <vector>

namespace laparoscope_servo {
namespace {

TEST(NaturalOrder, NumbersComeByTheirValueAndTheRestByBytes) {
  const std::vector<std::string> ordered{"",
                                         "0",
                                         "00",
                                         "1",
                                         "01",
                                         "001",
                                         "2",
                                         "10",
                                         "frame",
                                         "frame2",
                                         "frame02",
                                         "frame10",
                                         "frame10_1",
                                         "frame10_2",
                                         "frame10_10",
                                         "frame99999999999999999998",
                                         "frame99999999999999999999",
                                         "frame100000000000000000000",
                                         "framea",
                                         "g1",
                                         "\xC3\xA4"};
  std::mt19937 dice(1);
  for (int round = 0; round < 50; ++round) {
    std::vector<std::string> shuffled = ordered;
    std::shuffle(shuffled.begin(), shuffled.end(), dice);
    std::sort(shuffled.begin(), shuffled.end(), comesBefore);
    ASSERT_EQ(shuffled, ordered);
  }
}

// What std::sort relies on.
TEST(NaturalOrder, IsAStrictOrder) {
  const std::string letters = "01a2.";
  std::vector<std::string> names{""};
  for (std::size_t k = 0; names.size() < 156; ++k) {
    for (const char letter : letters) names.push_back(names[k] + letter);
  }
  for (const std::string& a : names) {
    EXPECT_FALSE(comesBefore(a, a)) << a;
    for (const std::string& b : names) {
      EXPECT_EQ(comesBefore(a, b) + comesBefore(b, a), a == b ? 0 : 1) << a << ' ' << b;
    }
  }
  std::sort(names.begin(), names.end(), comesBefore);
  for (std::size_t k = 0; k < names.size(); ++k) {
    for (std::size_t l = k + 1; l < names.size(); ++l) ASSERT_TRUE(comesBefore(names[k], names[l]));
  }
}

}  // namespace
}  // namespace laparoscope_servo
