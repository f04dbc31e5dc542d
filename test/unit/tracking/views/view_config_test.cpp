#include "laparoscope_servo/tracking/view_config.h"

#include <gtest/gtest.h>

#include <limits>

namespace laparoscope_servo::tracking {
namespace {

TEST(ViewConfigTest, DefaultsAreValid) {
  EXPECT_TRUE(validate(ViewConfig()).empty());
}

TEST(ViewConfigTest, NamesEveryFieldThatIsOutOfRange) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const ViewConfig config = {0, nan, -1.0, 2.0};
  const std::vector<std::string> errors = validate(config);
  ASSERT_EQ(errors.size(), 4u);
  const char* const fields[] = {"capacity = 0", "min_visible_fraction = nan", "arrival_centre = -1",
                                "arrival_scale = 2"};
  for (int k = 0; k < 4; ++k) EXPECT_EQ(errors[k].find(fields[k]), 0u) << errors[k];
}

}  // namespace
}  // namespace laparoscope_servo::tracking
