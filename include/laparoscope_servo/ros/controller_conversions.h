// Between the controller's messages and the core's types.
#pragma once

#include <geometry_msgs/Transform.h>
#include <laparoscope_servo/ControllerState.h>
#include <laparoscope_servo/OperatingState.h>
#include <laparoscope_servo/ScopeVelocity.h>
#include <laparoscope_servo/TaskError.h>

#include "laparoscope_servo/servo/controller.h"

namespace laparoscope_servo::skin {

// The ages are left to the caller.
servo::TaskErrorInput fromMessage(const TaskError& message);
servo::RobotFacts fromMessage(const OperatingState& message);

// d2 and the lateral offset from camera_T_insertion_point, O_A = (x, y, -d2) in camera coordinates. `problem` and `age`
// are left to the caller.
servo::DepthInput fromTransform(const geometry_msgs::Transform& camera_T_insertion_point);

// The header is left to the caller.
ScopeVelocity toMessage(const servo::ScopeVelocity& velocity);
ControllerState toMessage(const servo::ControllerOutput& output);

}  // namespace laparoscope_servo::skin
