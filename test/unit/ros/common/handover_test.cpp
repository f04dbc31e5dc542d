#include "ros/common/handover.h"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>
#include <vector>

namespace laparoscope_servo {
namespace {

TEST(Handover, HandsEachValueOnOnce) {
  Handover<int> handover;
  int value = 0;
  EXPECT_FALSE(handover.take(value));
  handover.give(3);
  EXPECT_TRUE(handover.take(value));
  EXPECT_EQ(value, 3);
  EXPECT_FALSE(handover.take(value));
}

TEST(Handover, TheNewestCounts) {
  Handover<int> handover;
  handover.give(3);
  handover.give(4);
  int value = 0;
  EXPECT_TRUE(handover.take(value));
  EXPECT_EQ(value, 4);
}

TEST(Handover, NoValueIsTornOrLostBetweenThreads) {
  constexpr int kLast = 2000;
  Handover<std::vector<int>> handover;
  std::thread giver([&] {
    for (int k = 1; k <= kLast; ++k) handover.give(std::vector<int>(20, k));
  });
  int seen = 0;
  std::vector<int> value;
  while (seen < kLast) {
    if (!handover.take(value)) continue;
    ASSERT_EQ(value, std::vector<int>(20, value.at(0)));
    ASSERT_GT(value[0], seen);
    seen = value[0];
  }
  giver.join();
}

}  // namespace
}  // namespace laparoscope_servo
