#include "ros/controller/controller_conversions.h"

#include <gtest/gtest.h>

#include <cmath>

#include "laparoscope_servo/scope/geometry.h"

namespace laparoscope_servo {
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
  message.visible_fraction = 0.75;
  message.corner_error = 0.5;
  message.valid = true;
  message.reference_stamp = ros::Time(3, 500000000);
  const servo::TaskErrorInput input = fromMessage(message);
  EXPECT_TRUE(input.valid);
  EXPECT_EQ(input.problem, "");
  EXPECT_EQ(input.visible_fraction, 0.75);
  EXPECT_EQ(input.corner_error, 0.5);
  EXPECT_EQ(input.region, 3.5);
  message.valid = false;
  EXPECT_FALSE(fromMessage(message).valid);
  const servo::TaskError& error = input.error;
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

geometry_msgs::Transform identity() {
  geometry_msgs::Transform transform;
  transform.rotation.w = 1.0;
  return transform;
}

// The insertion point lies behind the camera: z < 0 in camera coordinates.
TEST(ControllerConversions, DepthIsPositiveForACameraBeyondTheInsertionPoint) {
  geometry_msgs::Transform transform = identity();
  transform.translation.x = 0.003;
  transform.translation.y = -0.004;
  transform.translation.z = -0.1;
  const servo::DepthInput depth = fromTransforms(transform, identity());
  EXPECT_EQ(depth.d2, 0.1);
  EXPECT_DOUBLE_EQ(depth.lateral_offset, 0.005);
  EXPECT_TRUE(depth.camera_R_shaft.isIdentity(1e-15));
  ASSERT_TRUE(depth.insertion_point_T_tip.has_value());
  EXPECT_NEAR((depth.insertion_point_T_tip->translation() - Eigen::Vector3d(-0.003, 0.004, 0.1)).norm(), 0.0, 1e-15);
  transform.translation.z = 0.1;
  EXPECT_EQ(fromTransforms(transform, identity()).d2, -0.1);
}

TEST(ControllerConversions, ARotationThatIsNoneIsAProblem) {
  EXPECT_EQ(fromTransforms(identity(), identity()).problem, "");
  geometry_msgs::Transform none = identity();
  for (const double w : {0.0, std::nan("")}) {
    none.rotation.w = w;
    EXPECT_NE(fromTransforms(none, identity()).problem.find("rotation"), std::string::npos);
    EXPECT_NE(fromTransforms(identity(), none).problem.find("rotation"), std::string::npos);
  }
}

// Oblique optics: depth and offset count along and across the shaft, not the optical axis.
TEST(ControllerConversions, DepthIsAlongTheShaft) {
  const Eigen::Matrix3d camera_R_shaft = scope::obliqueOptics(0.5236, 0.8);
  const Eigen::Matrix3d insertion_point_R_shaft = geometry::so3Exp({3.0, 0.2, -0.4});
  const Eigen::Vector3d in_camera = camera_R_shaft * Eigen::Vector3d(0.002, 0.0, -0.12);
  const Eigen::Quaterniond shaft(camera_R_shaft), point(camera_R_shaft * insertion_point_R_shaft.transpose());
  geometry_msgs::Transform camera_T_insertion_point, camera_T_shaft;
  camera_T_insertion_point.translation.x = in_camera.x();
  camera_T_insertion_point.translation.y = in_camera.y();
  camera_T_insertion_point.translation.z = in_camera.z();
  const auto set = [](geometry_msgs::Quaternion& message, const Eigen::Quaterniond& q) {
    message.x = q.x();
    message.y = q.y();
    message.z = q.z();
    message.w = q.w();
  };
  set(camera_T_insertion_point.rotation, point);
  set(camera_T_shaft.rotation, shaft);
  const servo::DepthInput depth = fromTransforms(camera_T_insertion_point, camera_T_shaft);
  EXPECT_NEAR(depth.d2, 0.12, 1e-12);
  EXPECT_NEAR(depth.lateral_offset, 0.002, 1e-12);
  EXPECT_TRUE(depth.camera_R_shaft.isApprox(camera_R_shaft, 1e-12));
  EXPECT_TRUE(depth.insertion_point_T_tip->linear().isApprox(insertion_point_R_shaft, 1e-12));
  EXPECT_NEAR(
      (depth.insertion_point_T_tip->translation() - insertion_point_R_shaft * Eigen::Vector3d(-0.002, 0.0, 0.12))
          .norm(),
      0.0, 1e-12);
}

TEST(ControllerConversions, ATwistIsTurnedIntoTheShaftsAxes) {
  const Eigen::Matrix3d base_R_shaft = geometry::so3Exp({3.0, 0.2, -0.4});
  const Eigen::Vector3d w = base_R_shaft * Eigen::Vector3d(0.2, 0.1, 0.3),
                        v = base_R_shaft * Eigen::Vector3d(0.0, 0.0, 0.01);
  geometry_msgs::Twist twist;
  twist.angular.x = w.x();
  twist.angular.y = w.y();
  twist.angular.z = w.z();
  twist.linear.x = v.x();
  twist.linear.y = v.y();
  twist.linear.z = v.z();
  const Eigen::Vector4d velocity = fromTwist(twist, Eigen::Quaterniond(base_R_shaft.transpose())).vector();
  EXPECT_NEAR((velocity - Eigen::Vector4d(0.1, 0.2, 0.3, 0.01)).norm(), 0.0, 1e-12);
}

TEST(ControllerConversions, VelocityKeepsItsComponents) {
  const ScopeVelocity message = toMessage(scope::Velocity{1.0, 2.0, 3.0, 4.0});
  EXPECT_EQ(message.pan, 1.0);
  EXPECT_EQ(message.tilt, 2.0);
  EXPECT_EQ(message.spin, 3.0);
  EXPECT_EQ(message.insertion, 4.0);
}

TEST(ControllerConversions, AManualCommandKeepsItsComponents) {
  ScopeVelocity message;
  message.pan = 1.0;
  message.tilt = 2.0;
  message.spin = 3.0;
  message.insertion = 4.0;
  EXPECT_EQ(servoVelocity(message).vector(), Eigen::Vector4d(1.0, 2.0, 3.0, 4.0));
}

TEST(ControllerConversions, TasksHaveTheirNames) {
  servo::ControllerOutput output;
  EXPECT_EQ(toMessage(output).task, "HOLD_VIEW");
  output.task = servo::Task::kManual;
  EXPECT_EQ(toMessage(output).task, "MANUAL");
}

TEST(ControllerConversions, OnlyAnEnabledRobotIsEnabled) {
  for (const char* state : {"DISABLED", "PAUSED", "FAULT", "", "enabled"}) {
    OperatingState message;
    message.state = state;
    EXPECT_FALSE(fromMessage(message).enabled) << state;
    EXPECT_EQ(fromMessage(message).paused, std::string(state) == "PAUSED") << state;
    EXPECT_EQ(fromMessage(message).problem, "");
  }
  OperatingState message;
  message.state = "ENABLED";
  message.enables = 3;
  EXPECT_TRUE(fromMessage(message).enabled);
  EXPECT_EQ(fromMessage(message).enables, 3u);
}

TEST(ControllerConversions, StatesHaveTheirNames) {
  servo::ControllerOutput output;
  output.reason = "why";
  using State = servo::ControllerState;
  const std::pair<State, std::string> names[] = {{State::kIdle, "IDLE"},   {State::kArmed, "ARMED"},
                                                 {State::kServo, "SERVO"}, {State::kHold, "HOLD"},
                                                 {State::kLost, "LOST"},   {State::kFault, "FAULT"}};
  for (const auto& [state, name] : names) {
    output.state = state;
    EXPECT_EQ(toMessage(output).state, name);
    EXPECT_EQ(toMessage(output).reason, "why");
    EXPECT_EQ(toMessage(output).engaged != 0,
              state == State::kArmed || state == State::kServo || state == State::kHold);
  }
}

}  // namespace
}  // namespace laparoscope_servo
