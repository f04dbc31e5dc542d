#include "ros/common/service_callers.h"

#include <gtest/gtest.h>

namespace laparoscope_servo {
namespace {

TEST(ServiceCallers, withoutNamesEverybodyMayCall) {
  const ServiceCallers callers({});
  for (const char* caller : {"/theatre", "/rosservice_1_2", ""}) EXPECT_EQ(callers.refusal("enable", caller), "");
}

TEST(ServiceCallers, withNamesOnlyTheyMay) {
  const ServiceCallers callers({"/theatre", "/left/panel"});
  EXPECT_EQ(callers.refusal("enable", "/theatre"), "");
  EXPECT_EQ(callers.refusal("enable", "/left/panel"), "");
  for (const char* caller : {"/other", "theatre", "/theatre2", "/panel", ""}) {
    const std::string refusal = callers.refusal("enable", caller);
    EXPECT_NE(refusal.find("enable is refused"), std::string::npos) << caller;
    EXPECT_NE(refusal.find("service_callers"), std::string::npos) << caller;
  }
  EXPECT_NE(callers.refusal("enable", "/other").find("/other"), std::string::npos);
  EXPECT_EQ(callers.refusal("enable", "/a\nb").find('\n'), std::string::npos);
}

}  // namespace
}  // namespace laparoscope_servo
