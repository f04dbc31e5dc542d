#include "laparoscope_servo/aesop/operating_state.h"

#include <gtest/gtest.h>

#include <set>
#include <stdexcept>

namespace laparoscope_servo::aesop {
namespace {

constexpr OperatingMode kModes[] = {OperatingMode::kDisabled, OperatingMode::kEnabled, OperatingMode::kPaused,
                                    OperatingMode::kFault};

// Those of the Collaborative Robotics Toolkit, which the topic operating_state has.
TEST(OperatingState, ModesHaveTheToolkitsNames) {
  EXPECT_STREQ(name(OperatingMode::kDisabled), "DISABLED");
  EXPECT_STREQ(name(OperatingMode::kEnabled), "ENABLED");
  EXPECT_STREQ(name(OperatingMode::kPaused), "PAUSED");
  EXPECT_STREQ(name(OperatingMode::kFault), "FAULT");
  EXPECT_STREQ(name(static_cast<OperatingMode>(4)), "unknown");
}

TEST(OperatingState, EachStateComesBackFromItsRecording) {
  std::set<Bytes> forms;
  for (const OperatingMode mode : kModes) {
    for (const bool is_homed : {false, true}) {
      for (const bool is_busy : {false, true}) {
        for (const std::string& reason : {std::string(), std::string("asked for"), std::string("\0\xff", 2)}) {
          const OperatingState state{mode, is_homed, is_busy, reason};
          EXPECT_TRUE(stateOf(payloadOf(state)) == state) << name(mode) << is_homed << is_busy << reason;
          forms.insert(payloadOf(state));
        }
      }
    }
  }
  EXPECT_EQ(forms.size(), 4u * 2u * 2u * 3u) << "no two states look alike";
}

// doc/wire_log.md: a byte for the mode, one for the flags, the reason.
TEST(OperatingState, IsRecordedAsDocumented) {
  EXPECT_EQ(payloadOf({OperatingMode::kFault, true, false, "x"}), (Bytes{3, 1, 'x'}));
  EXPECT_EQ(payloadOf({OperatingMode::kPaused, false, true, ""}), (Bytes{2, 2}));
}

TEST(OperatingState, WhatIsNoneIsRefused) {
  for (const Bytes& bytes : {Bytes{}, Bytes{1}, Bytes{4, 0}, Bytes{255, 0}, Bytes{1, 4}, Bytes{1, 255, 'x'}})
    EXPECT_THROW(stateOf(bytes), std::invalid_argument) << bytes.size();
}

TEST(OperatingState, StatesAreEqualInAllOfTheirParts) {
  const OperatingState state{OperatingMode::kEnabled, true, false, "a"};
  EXPECT_TRUE(state == state);
  EXPECT_FALSE((state == OperatingState{OperatingMode::kPaused, true, false, "a"}));
  EXPECT_FALSE((state == OperatingState{OperatingMode::kEnabled, false, false, "a"}));
  EXPECT_FALSE((state == OperatingState{OperatingMode::kEnabled, true, true, "a"}));
  EXPECT_FALSE((state == OperatingState{OperatingMode::kEnabled, true, false, "b"}));
}

}  // namespace
}  // namespace laparoscope_servo::aesop
