#include "laparoscope_servo/ros/controller_conversions.h"

#include <cmath>

namespace laparoscope_servo::skin {

namespace {

Eigen::Vector3d vector(const geometry_msgs::Vector3& v) {
  return {v.x, v.y, v.z};
}

std::string name(servo::ControllerState state) {
  switch (state) {
    case servo::ControllerState::kArmed:
      return ControllerState::ARMED;
    case servo::ControllerState::kServo:
      return ControllerState::SERVO;
    case servo::ControllerState::kHold:
      return ControllerState::HOLD;
    case servo::ControllerState::kLost:
      return ControllerState::LOST;
    case servo::ControllerState::kFault:
      return ControllerState::FAULT;
    case servo::ControllerState::kIdle:
      break;
  }
  return ControllerState::IDLE;
}

}  // namespace

servo::TaskErrorInput fromMessage(const TaskError& message) {
  servo::TaskErrorInput input;
  input.problem.clear();
  input.valid = message.valid;
  input.visible_fraction = message.visible_fraction;
  input.corner_error = message.corner_error;
  servo::TaskError& error = input.error;
  error.e_v = vector(message.e_v);
  error.e_w = vector(message.e_w);
  error.m_star = vector(message.m_star);
  error.x = message.x;
  error.y = message.y;
  error.log_depth = message.log_depth;
  error.alpha = message.alpha;
  error.desired_x = message.desired_x;
  error.desired_y = message.desired_y;
  error.desired_log_depth = message.desired_log_depth;
  error.desired_alpha = message.desired_alpha;
  return input;
}

servo::DepthInput fromTransform(const geometry_msgs::Transform& camera_T_insertion_point) {
  const geometry_msgs::Vector3& o_a = camera_T_insertion_point.translation;
  servo::DepthInput depth;
  depth.d2 = -o_a.z;
  depth.lateral_offset = std::hypot(o_a.x, o_a.y);
  return depth;
}

servo::RobotFacts fromMessage(const OperatingState& message) {
  servo::RobotFacts robot;
  robot.problem.clear();
  robot.enabled = message.state == "ENABLED";
  return robot;
}

ScopeVelocity toMessage(const servo::ScopeVelocity& velocity) {
  ScopeVelocity message;
  message.pan = velocity.pan;
  message.tilt = velocity.tilt;
  message.spin = velocity.spin;
  message.insertion = velocity.insertion;
  return message;
}

ControllerState toMessage(const servo::ControllerOutput& output) {
  ControllerState message;
  message.state = name(output.state);
  message.engaged = output.engaged();
  message.reason = output.reason;
  return message;
}

}  // namespace laparoscope_servo::skin
