#include "laparoscope_servo/ros/future_transforms.h"

#include <gtest/gtest.h>

namespace laparoscope_servo::skin {
namespace {

class FutureTransformsTest : public ::testing::Test {
 protected:
  void put(double stamp, bool is_static = false) {
    geometry_msgs::TransformStamped transform;
    transform.header.frame_id = "base";
    transform.header.stamp = ros::Time(stamp);
    transform.child_frame_id = is_static ? "insertion_point" : "camera";
    transform.transform.rotation.w = 1.0;
    tf_.setTransform(transform, "test", is_static);
  }
  bool found(double now, double steady_now) { return future_.found(tf_, "base", "camera", ros::Time(now), steady_now); }
  double newest() const { return tf_.lookupTransform("base", "camera", ros::Time(0)).header.stamp.toSec(); }

  tf2::BufferCore tf_;
  FutureTransforms future_{0.25};
};

TEST_F(FutureTransformsTest, ThePresentIsLeftAlone) {
  EXPECT_FALSE(found(1000.0, 5.0)) << "there is none";
  put(999.0);
  EXPECT_FALSE(found(1000.0, 5.1));
  put(1000.2);
  EXPECT_FALSE(found(1000.0, 5.2)) << "clocks differ a little";
  EXPECT_EQ(newest(), 1000.2);
}

TEST_F(FutureTransformsTest, OneFromBeforeTimeJumpedBackBlocksNothing) {
  put(1000.0);  // time is 950
  put(950.0);
  ASSERT_EQ(newest(), 1000.0) << "tf drops the true one: else this class is not needed";
  EXPECT_TRUE(found(950.0, 5.0));
  EXPECT_TRUE(found(950.02, 5.02)) << "no true one has come yet";
  put(950.04);
  EXPECT_FALSE(found(950.04, 5.04));
  EXPECT_EQ(newest(), 950.04);
}

TEST_F(FutureTransformsTest, ASmallJumpDoesNotHideTheTrueOnesEither) {
  put(1000.0);
  put(995.0);  // within tf's history, but not the newest
  EXPECT_TRUE(found(995.0, 5.0));
  put(995.02);
  EXPECT_FALSE(found(995.02, 5.02));
}

TEST_F(FutureTransformsTest, AClockThatIsWrongIsFoundEachTime) {
  for (int k = 0; k < 300; ++k) {
    put(1003.0 + 0.02 * k);
    EXPECT_TRUE(found(1000.0 + 0.02 * k, 5.0 + 0.02 * k)) << k;
  }
}

TEST_F(FutureTransformsTest, TheAnswerEndsWhenNothingComes) {
  put(1000.0);
  EXPECT_TRUE(found(950.0, 5.0));
  EXPECT_TRUE(found(950.9, 5.9));
  EXPECT_FALSE(found(951.1, 6.1));
}

TEST_F(FutureTransformsTest, StaticOnesStay) {
  put(0.0, true);
  put(1000.0);
  EXPECT_TRUE(found(950.0, 5.0));
  EXPECT_TRUE(tf_.canTransform("base", "insertion_point", ros::Time(0)));
}

TEST_F(FutureTransformsTest, ClocksThatAreFarApartDoNotOverflow) {
  put(4e9);
  EXPECT_TRUE(found(1.0, 5.0));
}

}  // namespace
}  // namespace laparoscope_servo::skin
