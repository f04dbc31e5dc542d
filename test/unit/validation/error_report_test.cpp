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

}  // namespace
}  // namespace laparoscope_servo::validation
