// Conversions between the controller's messages and core types.
#pragma once

#include <geometry_msgs/Transform.h>
#include <geometry_msgs/Twist.h>
#include <laparoscope_servo/ControllerState.h>
#include <laparoscope_servo/OperatingState.h>
#include <laparoscope_servo/ScopeVelocity.h>
#include <laparoscope_servo/TaskError.h>

#include <optional>
#include <string>

#include "laparoscope_servo/servo/controller.h"

namespace laparoscope_servo {

// In front of the reason for which the service engage refuses.
constexpr char kNotEngaged[] = "not engaged: ";

std::string taskName(servo::Task task);
// Empty: there is none of that name.
std::optional<servo::Task> taskNamed(const std::string& name);
// All of them, for a text: "HOLD_VIEW, MANUAL, STABILISE or CENTRE_TIP".
std::string taskNames();

// Converts without checks; the result may be non-finite.
scope::Velocity servoVelocity(const ScopeVelocity& message);

// The caller fills in the ages.
servo::TaskErrorInput fromMessage(const TaskError& message);
servo::RobotFacts fromMessage(const OperatingState& message);

// Computes d2, lateral offset, optics and the tip's pose from the insertion point in the camera's frame, and from the
// axes of the shaft's frame in the camera's. The caller fills in `problem` and `age`.
servo::DepthInput fromTransforms(const geometry_msgs::Transform& camera_T_insertion_point,
                                 const geometry_msgs::Transform& camera_T_shaft);

// The scope's velocity from the camera's twist, given in a frame from which `shaft_R_frame` takes coordinates to the
// shaft's axes.
scope::Velocity fromTwist(const geometry_msgs::Twist& twist, const Eigen::Quaterniond& shaft_R_frame);

// The caller fills in the header.
ScopeVelocity toMessage(const scope::Velocity& velocity);
ControllerState toMessage(const servo::ControllerOutput& output);

}  // namespace laparoscope_servo
