#include "ros/common/recent_values.h"

#include <gtest/gtest.h>

namespace laparoscope_servo {
namespace {

TEST(RecentValuesTest, GivesTheNearestRankWhateverTheOrder) {
  RecentValues values;
  EXPECT_EQ(values.percentile(0.0, 0.95), 0.0);
  for (int k = 0; k < 100; ++k) values.add(1.0, 1.0 + (k * 37) % 100);  // 1 to 100
  EXPECT_EQ(values.percentile(1.0, 0.95), 95.0);
  EXPECT_EQ(values.percentile(1.0, 0.99), 99.0);
  EXPECT_EQ(values.percentile(1.0, 0.5), 50.0);
  EXPECT_EQ(values.percentile(1.0, 1.0), 100.0);
  EXPECT_EQ(values.percentile(1.0, 0.0), 1.0);
  EXPECT_EQ(values.sum(1.0), 5050.0);
}

TEST(RecentValuesTest, ForgetsWhatIsOlderThanAMinute) {
  RecentValues values;
  values.add(0.0, 100.0);
  values.add(30.0, 1.0);
  EXPECT_EQ(values.percentile(59.0, 1.0), 100.0);
  EXPECT_EQ(values.percentile(61.0, 1.0), 1.0);
  EXPECT_EQ(values.count(61.0), 1u);
  EXPECT_EQ(values.count(100.0), 0u);
}

TEST(RecentValuesTest, HoldsNoMoreThanItHasRoomFor) {
  RecentValues values;
  for (int k = 0; k < 100000; ++k) values.add(1.0, k);
  EXPECT_EQ(values.count(1.0), 20000u);
  EXPECT_EQ(values.percentile(1.0, 1.0), 99999.0);
}

}  // namespace
}  // namespace laparoscope_servo
