#include "laparoscope_servo/features/edge_memory.h"

#include <gtest/gtest.h>

namespace laparoscope_servo::features {
namespace {

TEST(EdgeMemory, asksTheNearestSlotThatIsKnown) {
  EdgeMemory memory;
  memory.reset(20, 20);
  EXPECT_EQ(memory.find(7), nullptr);
  memory.learn(3, {10.0f, 100.0f, 110.0f}, 1.0f);
  memory.learn(15, {20.0f, 50.0f, 70.0f}, 1.0f);
  EXPECT_EQ(memory.find(3)->contrast, 10.0f);
  EXPECT_EQ(memory.find(0)->contrast, 10.0f);
  EXPECT_EQ(memory.find(8)->contrast, 10.0f);
  EXPECT_EQ(memory.find(10)->contrast, 20.0f);
  EXPECT_EQ(memory.find(19)->contrast, 20.0f);
  memory.reset(20, 20);
  EXPECT_EQ(memory.find(3), nullptr);
}

TEST(EdgeMemory, doesNotAskASlotThatDoesNotLookAlike) {
  EdgeMemory memory;
  memory.reset(20, 2);
  memory.learn(3, {10.0f, 100.0f, 110.0f}, 1.0f);
  EXPECT_NE(memory.find(5), nullptr);
  EXPECT_EQ(memory.find(6), nullptr);
  EXPECT_EQ(memory.find(0), nullptr);
}

TEST(EdgeMemory, takesThePartOfANewImageThatIsAskedFor) {
  EdgeMemory memory;
  memory.reset(4, 4);
  // The first looks are taken whole.
  memory.learn(1, {10.0f, 100.0f, 110.0f}, 0.2f);
  EXPECT_EQ(memory.find(1)->contrast, 10.0f);
  memory.learn(1, {20.0f, 150.0f, 60.0f}, 0.2f);
  EXPECT_FLOAT_EQ(memory.find(1)->contrast, 12.0f);
  EXPECT_FLOAT_EQ(memory.find(1)->behind, 110.0f);
  EXPECT_FLOAT_EQ(memory.find(1)->ahead, 100.0f);
}

bool isAlike(const EdgeLooks& now, const EdgeLooks& before, int different = 0) {
  LooksComparison comparison;
  constexpr int kPairs = 20;
  for (int i = 0; i < kPairs; ++i) comparison.add(i < different ? EdgeLooks{-30.0f, 90.0f, 60.0f} : now, before);
  return comparison.isAlike(kPairs);
}

TEST(LooksComparison, bearsAGainOfTheLightButNoOtherLevels) {
  const EdgeLooks before{40.0f, 90.0f, 130.0f};
  EXPECT_TRUE(isAlike(before, before));
  EXPECT_TRUE(isAlike({36.0f, 81.0f, 117.0f}, before));
  // One side, or the contrast alone, is not what a gain does.
  EXPECT_FALSE(isAlike({40.0f, 60.0f, 130.0f}, before));
  EXPECT_FALSE(isAlike({28.0f, 90.0f, 130.0f}, before));
  // All of it, but darker by more than light changes.
  EXPECT_FALSE(isAlike({26.0f, 58.0f, 84.0f}, before));
}

TEST(LooksComparison, mostHaveToAgreeOneByOne) {
  const EdgeLooks before{40.0f, 90.0f, 130.0f};
  EXPECT_TRUE(isAlike(before, before, 0));
  EXPECT_FALSE(isAlike(before, before, 8));
}

}  // namespace
}  // namespace laparoscope_servo::features
