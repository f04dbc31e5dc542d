#include "laparoscope_servo/robust/largest.h"

#include <gtest/gtest.h>

#include <limits>

namespace laparoscope_servo::robust {
namespace {

TEST(Largest, keepsWhatIsNoNumber) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(largest(1.0, 2.0), 2.0);
  EXPECT_EQ(largest(2.0, -infinity), 2.0);
  for (const double other : {0.0, -1.0, infinity, nan}) {
    EXPECT_TRUE(std::isnan(largest(nan, other))) << other;
    EXPECT_TRUE(std::isnan(largest(other, nan))) << other;
  }
}

}  // namespace
}  // namespace laparoscope_servo::robust
