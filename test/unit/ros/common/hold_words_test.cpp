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

TEST(SliderWords, SayZeroForAMomentAfterwards) {
  using Word = SliderWords::Word;
  SliderWords words;
  EXPECT_EQ(words.turn(false), Word::kNothing);
  EXPECT_EQ(words.turn(true), Word::kZero) << "it is seen at rest first";
  EXPECT_EQ(words.turn(true), Word::kValue);
  EXPECT_EQ(words.turn(true), Word::kValue);
  int zeros = 0;
  while (words.turn(false) == Word::kZero) ++zeros;
  EXPECT_EQ(zeros, 10);
  EXPECT_EQ(words.turn(false), Word::kNothing);
}

}  // namespace
}  // namespace laparoscope_servo
