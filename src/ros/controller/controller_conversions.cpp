#include "ros/controller/controller_conversions.h"

#include <cmath>
#include <cstddef>
#include <iterator>

#include "ros/common/eigen_messages.h"

namespace laparoscope_servo {

namespace {

bool isRotation(const geometry_msgs::Quaternion& q) {
  const double length = Eigen::Vector4d(q.x, q.y, q.z, q.w).norm();
  return length > 1e-6 && std::isfinite(length);
}

}  // namespace

servo::TaskErrorInput fromMessage(const TaskError& message) {
  servo::TaskErrorInput input;
  input.problem.clear();
  input.valid = message.valid;
  input.region = message.reference_stamp.toSec();
  input.visible_fraction = message.visible_fraction;
  input.corner_error = message.corner_error;
  servo::TaskError& error = input.error;
  error.e_v = fromMessage(message.e_v);
  error.e_w = fromMessage(message.e_w);
  error.m_star = fromMessage(message.m_star);
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

servo::DepthInput fromTransforms(const geometry_msgs::Transform& camera_T_insertion_point,
                                 const geometry_msgs::Transform& camera_T_shaft) {
  servo::DepthInput depth;
  if (!isRotation(camera_T_insertion_point.rotation) || !isRotation(camera_T_shaft.rotation)) {
    depth.problem = "tf has a rotation that is none: a quaternion of length 0, or not finite";
    return depth;
  }
  depth.problem.clear();
  const Eigen::Quaterniond camera_R_insertion_point = fromMessage(camera_T_insertion_point.rotation);
  depth.camera_R_shaft = fromMessage(camera_T_shaft.rotation).toRotationMatrix();
  const Eigen::Vector3d in_camera = fromMessage(camera_T_insertion_point.translation);
  const Eigen::Vector3d along = depth.camera_R_shaft.transpose() * in_camera;  // from O_C to O_A, in the shaft's axes
  depth.d2 = -along.z();
  depth.lateral_offset = along.head<2>().norm();
  Eigen::Isometry3d tip = Eigen::Isometry3d::Identity();
  tip.linear() = camera_R_insertion_point.conjugate().toRotationMatrix() * depth.camera_R_shaft;
  tip.translation() = -(camera_R_insertion_point.conjugate() * in_camera);
  depth.insertion_point_T_tip = tip;
  return depth;
}

scope::Velocity fromTwist(const geometry_msgs::Twist& twist, const Eigen::Quaterniond& shaft_R_frame) {
  const Eigen::Vector3d w = shaft_R_frame * fromMessage(twist.angular);
  const Eigen::Vector3d v = shaft_R_frame * fromMessage(twist.linear);
  return {w.y(), w.x(), w.z(), v.z()};
}

servo::RobotFacts fromMessage(const OperatingState& message) {
  servo::RobotFacts robot;
  robot.problem.clear();
  robot.enabled = message.state == "ENABLED";
  robot.paused = message.state == "PAUSED";
  robot.enables = message.enables;
  return robot;
}

std::string taskName(servo::Task task) {
  switch (task) {
    case servo::Task::kHoldView:
      return ControllerState::HOLD_VIEW;
    case servo::Task::kManual:
      return ControllerState::MANUAL;
    case servo::Task::kStabilise:
      return ControllerState::STABILISE;
    case servo::Task::kCentreTip:
      return ControllerState::CENTRE_TIP;
    case servo::Task::kFollow:
      return ControllerState::FOLLOW;
    case servo::Task::kPoints:
      return ControllerState::POINTS;
    case servo::Task::kPosition:
      return ControllerState::POSITION;
    case servo::Task::kParallel:
      return ControllerState::PARALLEL;
  }
  return ControllerState::HOLD_VIEW;
}

std::optional<servo::Task> taskNamed(const std::string& name) {
  for (const servo::Task task : servo::kTasks) {
    if (taskName(task) == name) return task;
  }
  return std::nullopt;
}

std::string taskNames() {
  std::string names;
  for (std::size_t k = 0; k < std::size(servo::kTasks); ++k) {
    const bool last = k + 1 == std::size(servo::kTasks);
    names += (k == 0 ? "" : last ? " or " : ", ") + taskName(servo::kTasks[k]);
  }
  return names;
}

scope::Velocity servoVelocity(const ScopeVelocity& message) {
  return {message.pan, message.tilt, message.spin, message.insertion};
}

ScopeVelocity toMessage(const scope::Velocity& velocity) {
  ScopeVelocity message;
  message.pan = velocity.pan;
  message.tilt = velocity.tilt;
  message.spin = velocity.spin;
  message.insertion = velocity.insertion;
  return message;
}

ControllerState toMessage(const servo::ControllerOutput& output) {
  ControllerState message;
  message.task = taskName(output.task);
  message.state = servo::name(output.state);
  message.engaged = output.engaged();
  message.reason = output.reason;
  message.caution = output.caution;
  return message;
}

}  // namespace laparoscope_servo
