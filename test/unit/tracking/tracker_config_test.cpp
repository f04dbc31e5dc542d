#include "laparoscope_servo/tracking/tracker_config.h"

#include <gtest/gtest.h>

#include <cmath>

namespace laparoscope_servo::tracking {
namespace {

TEST(TrackerConfig, DefaultsAreValid) {
  EXPECT_TRUE(validate(TrackerConfig()).empty());
}

TEST(TrackerConfig, EveryErrorIsListedWithNameAndValue) {
  TrackerConfig c;
  c.occlusion.rows = 1;
  c.occlusion.threshold = std::nan("");
  c.esm.levels = 7;
  c.quality.confirmations = 0;
  const std::vector<std::string> errors = validate(c);
  ASSERT_EQ(errors.size(), 4u);
  EXPECT_EQ(errors[0], "occlusion/rows = 1, expected an integer in [2, 64] areas");
  EXPECT_NE(errors[1].find("occlusion/threshold = nan"), std::string::npos);
  EXPECT_NE(errors[2].find("esm/levels = 7"), std::string::npos);
  EXPECT_NE(errors[3].find("quality/confirmations = 0"), std::string::npos);
}

TEST(TrackerConfig, TheSearchHasRanges) {
  TrackerConfig c;
  c.search.max_features = 49;
  c.search.max_pixels = 0;
  c.search.max_ratio = std::nan("");
  c.search.min_inliers = 3;
  c.search.keyframes = -1;
  c.search.min_detail = -0.1;
  c.search.budget = 0.0;
  const std::vector<std::string> errors = validate(c);
  ASSERT_EQ(errors.size(), 7u);
  for (const std::string& error : errors) EXPECT_EQ(error.rfind("search/", 0), 0u) << error;
  EXPECT_EQ(errors[0], "search/max_features = 49, expected an integer in [50, 5000] points");
}

}  // namespace
}  // namespace laparoscope_servo::tracking
