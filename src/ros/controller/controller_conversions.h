// Between the controller's messages and the core's types.
#pragma once

#include <geometry_msgs/Transform.h>
#include <geometry_msgs/Twist.h>
#include <laparoscope_servo/ControllerState.h>
#include <laparoscope_servo/OperatingState.h>
#include <laparoscope_servo/ScopeVelocity.h>
#include <laparoscope_servo/TaskError.h>

#include "laparoscope_servo/servo/controller.h"

namespace laparoscope_servo {

std::string taskName(servo::Task task);

// As it is, finite or not.
scope::Velocity servoVelocity(const ScopeVelocity& message);

// The ages are left to the caller.
servo::TaskErrorInput fromMessage(const TaskError& message);
servo::RobotFacts fromMessage(const OperatingState& message);

// From the insertion point in the camera's frame, and the shaft's frame in the camera's, whose axes count: d2, the
// lateral offset, the optics, and the pose of the tip. `problem` and `age` are left to the caller.
servo::DepthInput fromTransforms(const geometry_msgs::Transform& camera_T_insertion_point,
                                 const geometry_msgs::Transform& camera_T_shaft);

// The scope's velocity from the camera's, both expressed in the frame from which `shaft_R_frame` leads to the shaft's
// axes.
scope::Velocity fromTwist(const geometry_msgs::Twist& twist, const Eigen::Quaterniond& shaft_R_frame);

// The header is left to the caller.
ScopeVelocity toMessage(const scope::Velocity& velocity);
ControllerState toMessage(const servo::ControllerOutput& output);

}  // namespace laparoscope_servo
