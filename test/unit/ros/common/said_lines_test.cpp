#include "ros/common/said_lines.h"

#include <gtest/gtest.h>

namespace laparoscope_servo {
namespace {

TEST(SaidLines, aNewLineIsSaidAtOnceAndOnlyOnce) {
  SaidLines lines;
  EXPECT_EQ(lines.take("a", 0.0), "a");
  for (double now = 0.0; now < 100.0; now += 0.5) EXPECT_FALSE(lines.take("a", now));
  EXPECT_EQ(lines.take("b", 100.0), "b");
  EXPECT_EQ(lines.take("a", 100.005), "a") << "back to what was said before is news";
}

TEST(SaidLines, theSameComesAgainAfterItsPause) {
  SaidLines lines(10.0);
  EXPECT_EQ(lines.take("a", 0.0), "a");
  EXPECT_FALSE(lines.take("a", 9.9));
  EXPECT_EQ(lines.take("b", 9.9), "b") << "the pause holds for the same line only";
  EXPECT_EQ(lines.take("a", 9.95), "a");
  EXPECT_FALSE(lines.take("a", 19.9));
  EXPECT_EQ(lines.take("a", 20.0), "a");
}

TEST(SaidLines, aFloodIsBoundedAndTheLastOneComes) {
  SaidLines lines;
  int said = 0;
  double now = 0.0;
  for (int k = 0; k < 12000; ++k, now += 0.005) said += lines.take(k % 2 == 0 ? "a" : "b", now).has_value() ? 1 : 0;
  EXPECT_GE(said, 100);
  EXPECT_LE(said, 131) << "10 at once, and 2 a second in 60 s";
  std::optional<std::string> last;
  const double end = now + 1.0;
  for (; now < end && !last; now += 0.005) last = lines.take("the end", now);
  ASSERT_TRUE(last);
  EXPECT_EQ(last->rfind("the end (", 0), 0u) << *last;
  EXPECT_FALSE(lines.take("the end", now + 5.0));
}

TEST(SaidLines, whatWaitedOnlyForItsTurnIsNotCountedAsMissing) {
  SaidLines lines;
  double now = 0.0;
  for (int k = 0; k < 10; ++k) ASSERT_TRUE(lines.take(std::to_string(k), now));
  EXPECT_FALSE(lines.take("late", now));
  EXPECT_FALSE(lines.take("late", now + 0.1));
  EXPECT_EQ(lines.take("late", now + 0.6), "late");
}

}  // namespace
}  // namespace laparoscope_servo
