#include "laparoscope_servo/ros/controller_conversions.h"

#include <gtest/gtest.h>

namespace laparoscope_servo::skin {
namespace {

TEST(ControllerConversions, TaskErrorKeepsEveryField) {
  TaskError message;
  message.e_v.x = 1.0;
  message.e_v.y = 2.0;
  message.e_v.z = 3.0;
  message.e_w.x = 4.0;
  message.e_w.y = 5.0;
  message.e_w.z = 6.0;
  message.m_star.x = 7.0;
  message.m_star.y = 8.0;
  message.m_star.z = 9.0;
  message.x = 10.0;
  message.y = 11.0;
  message.log_depth = 12.0;
  message.alpha = 13.0;
  message.desired_x = 14.0;
  message.desired_y = 15.0;
  message.desired_log_depth = 16.0;
  message.desired_alpha = 17.0;
  const servo::TaskError error = fromMessage(message);
  EXPECT_EQ(error.e_v, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(error.e_w, Eigen::Vector3d(4, 5, 6));
  EXPECT_EQ(error.m_star, Eigen::Vector3d(7, 8, 9));
  EXPECT_EQ(error.x, 10.0);
  EXPECT_EQ(error.y, 11.0);
  EXPECT_EQ(error.log_depth, 12.0);
  EXPECT_EQ(error.alpha, 13.0);
  EXPECT_EQ(error.desired_x, 14.0);
  EXPECT_EQ(error.desired_y, 15.0);
  EXPECT_EQ(error.desired_log_depth, 16.0);
  EXPECT_EQ(error.desired_alpha, 17.0);
}

// The insertion point lies behind the camera: z < 0 in camera coordinates.
TEST(ControllerConversions, DepthIsPositiveForACameraBeyondTheInsertionPoint) {
  geometry_msgs::Transform transform;
  transform.translation.x = 0.003;
  transform.translation.y = -0.004;
  transform.translation.z = -0.1;
  const servo::DepthInput depth = fromTransform(transform);
  EXPECT_EQ(depth.d2, 0.1);
  EXPECT_DOUBLE_EQ(depth.lateral_offset, 0.005);
  transform.translation.z = 0.1;
  EXPECT_EQ(fromTransform(transform).d2, -0.1);
}

TEST(ControllerConversions, VelocityKeepsItsComponents) {
  const ScopeVelocity message = toMessage(servo::ScopeVelocity{1.0, 2.0, 3.0, 4.0});
  EXPECT_EQ(message.pan, 1.0);
  EXPECT_EQ(message.tilt, 2.0);
  EXPECT_EQ(message.spin, 3.0);
  EXPECT_EQ(message.insertion, 4.0);
}

TEST(ControllerConversions, StatesHaveTheirNames) {
  servo::ControllerOutput output;
  output.reason = "why";
  output.state = servo::ControllerState::kIdle;
  EXPECT_EQ(toMessage(output).state, ControllerState::IDLE);
  EXPECT_FALSE(toMessage(output).engaged);
  EXPECT_EQ(toMessage(output).reason, "why");
  output.state = servo::ControllerState::kServo;
  EXPECT_EQ(toMessage(output).state, ControllerState::SERVO);
  EXPECT_TRUE(toMessage(output).engaged);
  output.state = servo::ControllerState::kHold;
  EXPECT_EQ(toMessage(output).state, ControllerState::HOLD);
  EXPECT_TRUE(toMessage(output).engaged);
}

}  // namespace
}  // namespace laparoscope_servo::skin
