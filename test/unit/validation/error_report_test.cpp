#include "laparoscope_servo/validation/error_report.h"

#include <gtest/gtest.h>

namespace laparoscope_servo::validation {
namespace {

TEST(ErrorReport, listsAllErrors) {
  EXPECT_NO_THROW(throwErrors("arm", {}));
  try {
    throwErrors("arm", {"delay = -1, expected 0 to 2", "rate = 0"});
    FAIL() << "two errors";
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "arm: delay = -1, expected 0 to 2; rate = 0");
  }
}

TEST(ErrorReport, saysWhoseErrorsTheyAre) {
  std::vector<std::string> all{"rate = 0"};
  addGroup("arm", {"delay = -1, expected 0 to 2", "joint = 9"}, all);
  addGroup("line", {}, all);
  EXPECT_EQ(all, (std::vector<std::string>{"rate = 0", "arm/delay = -1, expected 0 to 2", "arm/joint = 9"}));
}

}  // namespace
}  // namespace laparoscope_servo::validation
