#include "laparoscope_servo/tracking/tracker_config.h"

#include <gtest/gtest.h>

#include <cmath>

namespace laparoscope_servo::tracking {
namespace {

TEST(TrackerConfig, DefaultsAreValid) { EXPECT_TRUE(validate(TrackerConfig()).empty()); }

TEST(TrackerConfig, EveryErrorIsListedWithNameAndValue) {
  TrackerConfig c;
  c.occlusion.rows = 1;
  c.occlusion.threshold = std::nan("");
  c.esm.levels = 7;
  c.quality.confirmations = 0;
  const std::vector<std::string> errors = validate(c);
  ASSERT_EQ(errors.size(), 4u);
  EXPECT_EQ(errors[0], "occlusion/rows = 1, expected 2 to 64");
  EXPECT_NE(errors[1].find("occlusion/threshold = nan"), std::string::npos);
  EXPECT_NE(errors[2].find("esm/levels = 7"), std::string::npos);
  EXPECT_NE(errors[3].find("quality/confirmations = 0"), std::string::npos);
}

}  // namespace
}  // namespace laparoscope_servo::tracking
