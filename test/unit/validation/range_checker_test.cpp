#include "laparoscope_servo/validation/range_checker.h"

#include <gtest/gtest.h>

#include <limits>

namespace laparoscope_servo::validation {
namespace {

TEST(RangeChecker, TakesBothEndsOfTheRange) {
  RangeChecker check;
  check.range("a", 0.5, 0.5, 2.0);
  check.range("b", 2.0, 0.5, 2.0);
  check.range("c", 3, 3, 3);
  EXPECT_TRUE(check.errors().empty());
}

TEST(RangeChecker, NamesFieldValueAndWhatWasExpectedInOrder) {
  RangeChecker check;
  check.range("gains/pan", -1.0, 0.0, 5.0, "1/s");
  check.range("rows", 65, 2, 64);
  check.add("columns are missing");
  const std::vector<std::string> expected = {"gains/pan = -1, expected a number in [0, 5] 1/s",
                                             "rows = 65, expected a number in [2, 64]", "columns are missing"};
  EXPECT_EQ(check.errors(), expected);
}

TEST(RangeChecker, RefusesWhatIsNotANumber) {
  RangeChecker check;
  check.range("a", std::numeric_limits<double>::quiet_NaN(), 0.0, 1.0);
  check.range("b", std::numeric_limits<double>::infinity(), 0.0, 1.0);
  EXPECT_EQ(check.errors().size(), 2u);
}

}  // namespace
}  // namespace laparoscope_servo::validation
