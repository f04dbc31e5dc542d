#include "laparoscope_servo/aesop/session_reason.h"

#include <gtest/gtest.h>

#include <set>

#include "laparoscope_servo/aesop/messages.h"

namespace laparoscope_servo::aesop {
namespace {

using Kind = SessionReason::Kind;

constexpr Kind kLast = Kind::kDisableConfirmedLate;

// A user who reads one text knows which of them it is; none of them is empty but that of no reason.
TEST(SessionReason, EachKindHasItsOwnText) {
  std::set<std::string> texts;
  for (int k = 0; k <= static_cast<int>(kLast); ++k) {
    const std::string words = text({static_cast<Kind>(k), kFaultMotor, "given"});
    EXPECT_EQ(words.empty(), static_cast<Kind>(k) == Kind::kNone) << k;
    EXPECT_TRUE(texts.insert(words).second) << words;
  }
  EXPECT_EQ(texts.size(), static_cast<std::size_t>(kLast) + 1u);
}

TEST(SessionReason, WhatIsGivenIsSaidAsItIs) {
  EXPECT_EQ(text({Kind::kGiven, 0, "stopped by /somebody"}), "stopped by /somebody");
}

TEST(SessionReason, AFaultNamesItsCauses) {
  EXPECT_EQ(text({Kind::kFault, kFaultMotor, ""}), "fault: motor");
  EXPECT_EQ(text({Kind::kFault, kFaultMotor | kFaultSensor, ""}), "fault: motor, joint sensor");
  EXPECT_EQ(text({Kind::kFault, 0, ""}), "fault: the controller names no cause");
  EXPECT_EQ(text({Kind::kFaultNotCleared, kFaultJointLimit, ""}), "fault: joint limit; it could not be cleared");
}

// A fault that was cleared, or has gone, is none.
TEST(SessionReason, OnlyTwoKindsAreAFault) {
  for (int k = 0; k <= static_cast<int>(kLast); ++k) {
    const Kind kind = static_cast<Kind>(k);
    EXPECT_EQ((SessionReason{kind, kFaultMotor, ""}.isFault()), kind == Kind::kFault || kind == Kind::kFaultNotCleared)
        << k;
  }
}

}  // namespace
}  // namespace laparoscope_servo::aesop
