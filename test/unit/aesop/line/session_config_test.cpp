#include "laparoscope_servo/aesop/session_config.h"

#include <gtest/gtest.h>

#include <limits>

namespace laparoscope_servo::aesop {
namespace {

TEST(SessionConfig, errorsAreNamed) {
  EXPECT_TRUE(validate(SessionConfig()).empty());
  SessionConfig config;
  config.rate = config.time_to_live = config.status_timeout = config.request_timeout =
      std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(validate(config).size(), 4u);
  config = SessionConfig();
  config.rate = 5.0;  // one period is the whole time to live
  ASSERT_EQ(validate(config).size(), 1u);
  EXPECT_NE(validate(config)[0].find("stutters"), std::string::npos);
}

TEST(SessionConfig, needsACodec) {
  SessionConfig config;
  config.codec = nullptr;
  ASSERT_EQ(validate(config).size(), 1u);
  EXPECT_NE(validate(config)[0].find("codec"), std::string::npos);
}

TEST(SessionConfig, warnsWhenTheLineIsTooSlow) {
  SessionConfig config;
  EXPECT_EQ(lineWarning(config, 38400), "");
  const std::string warning = lineWarning(config, 9600);
  EXPECT_NE(warning.find("30000 bit/s"), std::string::npos) << warning;
  EXPECT_NE(warning.find("at most 11 Hz"), std::string::npos) << warning;
  config.rate = 11.0;
  EXPECT_EQ(lineWarning(config, 9600), "");
}

}  // namespace
}  // namespace laparoscope_servo::aesop
