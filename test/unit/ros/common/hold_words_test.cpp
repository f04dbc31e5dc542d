#include "ros/common/hold_words.h"

#include <gtest/gtest.h>

#include <vector>

namespace laparoscope_servo {
namespace {

using Words = std::vector<bool>;

TEST(DeadManWords, SayReleasedBeforePressedAndThenFallSilent) {
  DeadManWords words;
  EXPECT_EQ(words.turn(false), Words{}) << "who holds another switch is not disturbed";
  EXPECT_EQ(words.turn(true), (Words{false, true}));
  EXPECT_EQ(words.turn(true), Words{true});
  EXPECT_EQ(words.turn(false), Words{false});
  Words farewells;
  for (int k = 0; k < 20; ++k) {
    for (const bool word : words.turn(false)) farewells.push_back(word);
  }
  EXPECT_EQ(farewells, (Words{false, false}));
  EXPECT_EQ(words.turn(true), (Words{false, true}));
}

TEST(SliderWords, SayZeroLongEnoughToBeSeenBeforeAndForAMomentAfterwards) {
  using Word = SliderWords::Word;
  SliderWords words;
  double now = 7.0;
  EXPECT_EQ(words.turn(false, now), Word::kNothing);
  EXPECT_EQ(words.turn(true, now), Word::kZero) << "it is seen at rest first";
  EXPECT_EQ(words.turn(true, now + 0.001), Word::kZero) << "a hand that draws at once wakes the sender at once";
  EXPECT_EQ(words.turn(true, now + 0.99 * SliderWords::kRest), Word::kZero);
  now += 1.01 * SliderWords::kRest;
  EXPECT_EQ(words.turn(true, now), Word::kValue);
  EXPECT_EQ(words.turn(true, now + 1.0), Word::kValue);
  int zeros = 0;
  while (words.turn(false, now + 1.1) == Word::kZero) ++zeros;
  EXPECT_EQ(zeros, 10);
  EXPECT_EQ(words.turn(false, now + 1.1), Word::kNothing);
  EXPECT_EQ(words.turn(true, now + 1.2), Word::kZero) << "each time that it is taken";
}

}  // namespace
}  // namespace laparoscope_servo
