#include "laparoscope_servo/ros/static_frame_watch.h"

#include <gtest/gtest.h>

namespace laparoscope_servo::skin {
namespace {

void put(tf2::BufferCore& tf, const std::string& parent, double x, bool is_static, double time = 1.0) {
  geometry_msgs::TransformStamped transform;
  transform.header.frame_id = parent;
  transform.header.stamp = ros::Time(time);
  transform.child_frame_id = "insertion_point";
  transform.transform.translation.x = x;
  transform.transform.rotation.w = 1.0;
  ASSERT_TRUE(tf.setTransform(transform, "test", is_static));
}

TEST(StaticFrameWatch, TellsOnceThatTheFrameIsElsewhere) {
  tf2::BufferCore tf;
  StaticFrameWatch watch;
  EXPECT_FALSE(watch.moved(tf, "insertion_point")) << "there is none";
  put(tf, "base", 0.5, true);
  EXPECT_FALSE(watch.moved(tf, "insertion_point")) << "the first is no other one";
  put(tf, "base", 0.5, true);
  EXPECT_FALSE(watch.moved(tf, "insertion_point")) << "sent again";
  put(tf, "base", 0.502, true);
  EXPECT_TRUE(watch.moved(tf, "insertion_point"));
  EXPECT_FALSE(watch.moved(tf, "insertion_point"));
  put(tf, "another_base", 0.502, true);
  EXPECT_TRUE(watch.moved(tf, "insertion_point"));
}

TEST(StaticFrameWatch, AGapIsNoMove) {
  tf2::BufferCore tf;
  StaticFrameWatch watch;
  put(tf, "base", 0.5, true);
  EXPECT_FALSE(watch.moved(tf, "insertion_point"));
  tf2::BufferCore empty;
  EXPECT_FALSE(watch.moved(empty, "insertion_point"));
  EXPECT_FALSE(watch.moved(tf, "insertion_point"));
  put(tf, "base", 0.6, true);
  EXPECT_TRUE(watch.moved(tf, "insertion_point")) << "what was known before the gap";
}

TEST(StaticFrameWatch, AFrameThatMovesAnywayIsNotWatched) {
  tf2::BufferCore tf;
  StaticFrameWatch watch;
  for (int k = 1; k < 5; ++k) {
    put(tf, "camera", 0.1 * k, false, k);
    EXPECT_FALSE(watch.moved(tf, "insertion_point"));
  }
}

}  // namespace
}  // namespace laparoscope_servo::skin
