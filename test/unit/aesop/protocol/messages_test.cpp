#include "laparoscope_servo/aesop/messages.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace laparoscope_servo::aesop {
namespace {

constexpr std::uint16_t kNamed[] = {kFaultEmergencyStop, kFaultMotor, kFaultSensor, kFaultJointLimit, kFaultTrocar};

TEST(Messages, StatesHaveTheirNames) {
  EXPECT_STREQ(name(RobotState::kDisabled), "DISABLED");
  EXPECT_STREQ(name(RobotState::kEnabled), "ENABLED");
  EXPECT_STREQ(name(RobotState::kFault), "FAULT");
  EXPECT_STREQ(name(static_cast<RobotState>(7)), "unknown");
}

TEST(Messages, NoFaultHasNoWords) {
  EXPECT_EQ(describeFaults(0), "");
}

TEST(Messages, EachFaultHasItsName) {
  EXPECT_EQ(describeFaults(kFaultEmergencyStop), "emergency stop");
  EXPECT_EQ(describeFaults(kFaultTrocar), "the shaft cannot follow the trocar");
  std::set<std::string> names;
  for (const std::uint16_t bit : kNamed) names.insert(describeFaults(bit));
  EXPECT_EQ(names.size(), std::size(kNamed));
}

// Each set of bits is told whole: the names of those that have one, joined by commas, and the rest as a number.
TEST(Messages, NoBitIsLost) {
  std::uint16_t all_named = 0;
  for (const std::uint16_t bit : kNamed) all_named = static_cast<std::uint16_t>(all_named | bit);
  for (unsigned faults = 1; faults <= 0xFFFF; faults += faults < 0x100 ? 1 : 37) {
    const std::string text = describeFaults(static_cast<std::uint16_t>(faults));
    int parts = 0;
    for (const std::uint16_t bit : kNamed) {
      const bool is_set = (faults & bit) != 0;
      parts += is_set ? 1 : 0;
      EXPECT_EQ(text.find(describeFaults(bit)) != std::string::npos, is_set) << text;
    }
    const unsigned unknown = faults & ~static_cast<unsigned>(all_named);
    const std::string::size_type at = text.find("unknown fault bits 0x");
    ASSERT_EQ(at != std::string::npos, unknown != 0) << text;
    if (unknown != 0) {
      EXPECT_EQ(std::stoul(text.substr(at + 21), nullptr, 16), unknown) << text;
    }
    EXPECT_EQ(std::count(text.begin(), text.end(), ','), parts + (unknown != 0 ? 1 : 0) - 1) << text;
  }
}

}  // namespace
}  // namespace laparoscope_servo::aesop
