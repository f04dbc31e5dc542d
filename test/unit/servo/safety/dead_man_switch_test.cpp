#include "laparoscope_servo/servo/dead_man_switch.h"

#include <gtest/gtest.h>

namespace laparoscope_servo::servo {
namespace {

DeadManSwitch::Source source() {
  return std::make_shared<int>(0);
}

TEST(DeadManSwitch, SilenceIsReleased) {
  DeadManSwitch dead_man(0.2);
  EXPECT_FALSE(dead_man.facts(0.0).pressed);
  EXPECT_GT(dead_man.facts(0.0).age, 1e9);
  const auto one = source();
  dead_man.said(one, false, true, 0.0);
  dead_man.said(one, true, true, 0.1);
  EXPECT_TRUE(dead_man.facts(0.3).pressed);
  EXPECT_NEAR(dead_man.facts(0.3).age, 0.2, 1e-12);
  EXPECT_FALSE(dead_man.facts(0.31).pressed);
  EXPECT_FALSE(dead_man.facts(0.05).pressed) << "a word from later";
}

TEST(DeadManSwitch, HasToBeSeenReleasedAfterEngaging) {
  DeadManSwitch dead_man(0.2);
  const auto one = source();
  dead_man.said(one, true, true, 0.0);
  EXPECT_FALSE(dead_man.facts(0.0).pressed);
  EXPECT_NE(dead_man.facts(0.0).problem.find("release it once"), std::string::npos);
  dead_man.said(one, false, true, 0.1);
  EXPECT_FALSE(dead_man.facts(0.1).pressed);
  EXPECT_EQ(dead_man.facts(0.1).problem, "");
  dead_man.said(one, true, true, 0.2);
  EXPECT_TRUE(dead_man.facts(0.2).pressed);
  dead_man.engaging();
  EXPECT_FALSE(dead_man.facts(0.2).pressed);
  dead_man.said(one, true, true, 0.3);
  EXPECT_NE(dead_man.facts(0.3).problem, "");
}

TEST(DeadManSwitch, AForgottenPublisherThatAlwaysSaysPressedNeverCounts) {
  DeadManSwitch dead_man(0.2);
  const auto forgotten = source();
  const auto own = source();
  for (int k = 0; k < 100; ++k) {
    const double now = 0.3 * k;
    dead_man.said(forgotten, true, true, now);
    EXPECT_FALSE(dead_man.facts(now).pressed) << "it alone";
    dead_man.said(own, k % 2 == 1, true, now);
    EXPECT_EQ(dead_man.facts(now).pressed, k % 2 == 1);
  }
  EXPECT_FALSE(dead_man.facts(29.95).pressed) << "its own switch is silent";
}

TEST(DeadManSwitch, AnyFreshReleaseWins) {
  DeadManSwitch dead_man(0.2);
  const auto first = source();
  const auto second = source();
  const auto other = source();
  for (const auto& one : {first, second}) dead_man.said(one, false, true, 0.0);
  for (const auto& one : {first, second}) dead_man.said(one, true, true, 0.1);
  EXPECT_TRUE(dead_man.facts(0.1).pressed);
  dead_man.said(second, false, true, 0.15);
  dead_man.said(first, true, true, 0.2);
  EXPECT_FALSE(dead_man.facts(0.2).pressed);
  EXPECT_EQ(dead_man.facts(0.2).problem, "");
  dead_man.said(first, true, true, 0.36);
  EXPECT_TRUE(dead_man.facts(0.36).pressed) << "that release is too old";
  dead_man.said(other, false, false, 0.37);
  EXPECT_FALSE(dead_man.facts(0.37).pressed) << "whoever says it";
}

TEST(DeadManSwitch, OnlyWhoMayPressCanPress) {
  DeadManSwitch dead_man(0.2);
  const auto stranger = source();
  dead_man.said(stranger, false, false, 0.0);
  dead_man.said(stranger, true, false, 0.1);
  EXPECT_FALSE(dead_man.facts(0.1).pressed);
}

TEST(DeadManSwitch, ManySourcesTakeNothingFromARelease) {
  DeadManSwitch dead_man(0.2);
  for (int k = 0; k < 1000; ++k) dead_man.said(source(), true, true, 1e-5 * k);
  EXPECT_FALSE(dead_man.facts(0.01).pressed);
  const auto own = source();
  dead_man.said(own, false, true, 0.02);
  EXPECT_EQ(dead_man.facts(0.02).problem, "");
  dead_man.said(own, true, true, 0.03);
  EXPECT_TRUE(dead_man.facts(0.03).pressed);
}

}  // namespace
}  // namespace laparoscope_servo::servo
