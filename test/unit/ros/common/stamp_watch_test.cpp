#include "ros/common/stamp_watch.h"

#include <gtest/gtest.h>

namespace laparoscope_servo {
namespace {

using Arrival = StampWatch::Arrival;

TEST(StampWatch, AgeIsTheLargerOfBothClocks) {
  StampWatch watch;
  EXPECT_TRUE(watch.empty());
  EXPECT_EQ(watch.arrived(ros::Time(100.0), 5.0), Arrival::kNew);
  EXPECT_FALSE(watch.empty());
  EXPECT_NEAR(watch.age(ros::Time(100.3), 5.1), 0.3, 1e-9);  // it waited in a queue
  EXPECT_NEAR(watch.age(ros::Time(100.0), 5.4), 0.4, 1e-9);  // ROS time stands still
  EXPECT_EQ(watch.age(ros::Time(90.0), 5.0), 0.0);           // never negative
}

TEST(StampWatch, RepeatedStampsDoNotKeepItYoung) {
  StampWatch watch;
  watch.arrived(ros::Time(100.0), 5.0);
  EXPECT_EQ(watch.arrived(ros::Time(100.0), 6.0), Arrival::kRepeated);
  EXPECT_NEAR(watch.age(ros::Time(100.0), 6.0), 1.0, 1e-9);
}

TEST(StampWatch, TellsSilenceFromOldData) {
  StampWatch watch;
  watch.arrived(ros::Time(100.0), 5.0);
  EXPECT_NEAR(watch.silence(5.5), 0.5, 1e-9);
  EXPECT_NEAR(watch.stampAge(ros::Time(100.2)), 0.2, 1e-6);
  EXPECT_EQ(watch.silence(4.0), 0.0);
  EXPECT_EQ(watch.stampAge(ros::Time(99.0)), 0.0);
}

TEST(StampWatch, NoticesStampsThatGoBackAndStartsAnew) {
  StampWatch watch;
  watch.arrived(ros::Time(100.0), 5.0);
  EXPECT_EQ(watch.arrived(ros::Time(99.0), 5.1), Arrival::kBack);
  EXPECT_EQ(watch.arrived(ros::Time(99.1), 5.2), Arrival::kNew);
}

TEST(StampWatch, NoticesStampsAheadOfTime) {
  StampWatch watch;
  watch.arrived(ros::Time(100.0), 5.0);
  EXPECT_FALSE(watch.isAhead(ros::Time(99.8), 0.25));
  EXPECT_TRUE(watch.isAhead(ros::Time(99.7), 0.25));
}

TEST(StampWatch, ClearForgets) {
  StampWatch watch;
  watch.arrived(ros::Time(100.0), 5.0);
  watch.clear();
  EXPECT_TRUE(watch.empty());
  EXPECT_EQ(watch.arrived(ros::Time(50.0), 6.0), Arrival::kNew);
}

}  // namespace
}  // namespace laparoscope_servo
