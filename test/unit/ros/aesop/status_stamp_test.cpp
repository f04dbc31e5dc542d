#include "ros/aesop/status_stamp.h"

#include <gtest/gtest.h>

#include <limits>

namespace laparoscope_servo {
namespace {

TEST(StatusStamp, isWhenTheRequestWasSent) {
  StatusStamp stamps;
  const auto first = stamps.take(0.02, 100.0, ros::Time(5000.0));
  ASSERT_TRUE(first);
  EXPECT_NEAR(first->toSec(), 4999.98, 1e-6);
  const auto late = stamps.take(0.2, 100.3, ros::Time(5000.3));
  ASSERT_TRUE(late);
  EXPECT_NEAR(late->toSec(), 5000.1, 1e-6);
}

// The same request answered again, or one before it.
TEST(StatusStamp, noneComesTwiceOrGoesBack) {
  StatusStamp stamps;
  ASSERT_TRUE(stamps.take(0.02, 100.0, ros::Time(5000.0)));
  EXPECT_FALSE(stamps.take(0.03, 100.01, ros::Time(5000.01)));
  EXPECT_FALSE(stamps.take(0.1, 100.02, ros::Time(5000.02)));
  EXPECT_TRUE(stamps.take(0.02, 100.025, ros::Time(5000.025)));
}

TEST(StatusStamp, rosTimeMayBeginAnewOrGoBack) {
  StatusStamp stamps;
  ASSERT_TRUE(stamps.take(0.02, 100.0, ros::Time(5000.0)));
  const auto back = stamps.take(0.02, 100.1, ros::Time(10.0));
  ASSERT_TRUE(back);
  EXPECT_NEAR(back->toSec(), 9.98, 1e-6);
  const auto none = stamps.take(0.02, 100.2, ros::Time(0.01));
  ASSERT_TRUE(none);
  EXPECT_TRUE(none->isZero());
}

TEST(StatusStamp, anAgeThatIsUnknownHasNone) {
  StatusStamp stamps;
  EXPECT_FALSE(stamps.take(std::numeric_limits<double>::infinity(), 100.0, ros::Time(5000.0)));
  EXPECT_FALSE(stamps.take(std::numeric_limits<double>::quiet_NaN(), 100.0, ros::Time(5000.0)));
  EXPECT_TRUE(stamps.take(0.0, 100.0, ros::Time(5000.0)));
}

}  // namespace
}  // namespace laparoscope_servo
