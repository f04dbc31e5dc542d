#include "laparoscope_servo/servo/controller.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

namespace laparoscope_servo::servo {

namespace {

ControllerConfig checked(const ControllerConfig& config) {
  std::string text;
  for (const std::string& error : validate(config)) text += (text.empty() ? "" : "; ") + error;
  if (!text.empty()) throw std::invalid_argument("controller: " + text);
  return config;
}

std::string seconds(double time) {
  std::ostringstream text;
  text << time << " s";
  return text.str();
}

// Written so that a NaN age is not fresh.
bool isFresh(double age, double limit) {
  return age >= 0.0 && age <= limit;
}

std::string problemWithTaskError(const TaskErrorInput& input, const SafetyConfig& safety) {
  if (!input.problem.empty()) return input.problem;
  if (!isFresh(input.age, safety.max_task_error_age)) {
    return "task error is older than " + seconds(safety.max_task_error_age);
  }
  if (!input.valid) return "task error is not valid: the tracker does not track, or has no intrinsics";
  if (!isFinite(input.error)) return "task error is not finite";
  return "";
}

std::string problemWithDepth(const DepthInput& input, const SafetyConfig& safety) {
  if (!input.problem.empty()) return input.problem;
  if (!isFresh(input.age, safety.max_depth_age)) return "depth d2 is older than " + seconds(safety.max_depth_age);
  std::ostringstream text;
  if (!(input.d2 >= safety.min_depth && input.d2 <= safety.max_depth)) {
    text << "depth d2 is not between " << safety.min_depth << " and " << safety.max_depth << " m";
  } else if (!(input.lateral_offset >= 0.0 && input.lateral_offset <= safety.max_lateral_offset)) {
    text << "the shaft passes the insertion point at more than " << safety.max_lateral_offset << " m";
  }
  return text.str();
}

}  // namespace

std::string problemWith(const ControllerInput& input, const SafetyConfig& safety) {
  const std::string problem = problemWithTaskError(input.task_error, safety);
  return problem.empty() ? problemWithDepth(input.depth, safety) : problem;
}

Controller::Controller(const ControllerConfig& config) : config_(checked(config)), servo_(config) {}

std::string Controller::engage(const ControllerInput& input) {
  if (engaged_) return "";
  if (!std::isfinite(input.time)) return "time is not finite";
  const std::string problem = problemWith(input, config_.safety);
  if (!problem.empty()) return problem;
  engaged_ = true;
  holding_ = false;
  has_time_ = false;  // the pause since the last step is no step
  servo_.reset();
  return "";
}

void Controller::disengage(const std::string& reason) {
  engaged_ = false;
  holding_ = false;
  reason_ = reason;
  servo_.reset();
}

ControllerOutput Controller::update(const ControllerInput& input) {
  if (input.robot_report.present) servo_.report(input.time - input.robot_report.age, input.robot_report.velocity);
  if (!engaged_) return stopped();
  if (!std::isfinite(input.time) || (has_time_ && input.time < last_time_)) {
    disengage("time jumped back; engage again");
    return stopped();
  }
  std::string problem = problemWith(input, config_.safety);
  ControllerOutput output;
  if (problem.empty()) {
    output.command = servo(input);
    if (!output.command.vector().allFinite()) problem = "the control law's velocity is not finite";
  }
  last_time_ = input.time;
  has_time_ = true;
  if (!problem.empty()) {
    hold(input.time, problem);
    return stopped();
  }
  holding_ = false;
  output.state = ControllerState::kServo;
  return output;
}

ScopeVelocity Controller::servo(const ControllerInput& input) {
  ServoInput servo;
  servo.time = input.time;
  servo.image_time = input.time - input.task_error.age;
  servo.error = input.task_error.error;
  servo.scope = {input.depth.camera_R_shaft, input.depth.d2};
  servo.period = has_time_ ? std::min(input.time - last_time_, config_.safety.max_period) : 0.0;
  return servo_.command(servo, ServoLimits());
}

void Controller::hold(double time, const std::string& reason) {
  if (!holding_) hold_since_ = time;
  holding_ = true;
  reason_ = reason;
  servo_.stop(time);
  if (time - hold_since_ >= config_.safety.resume_time) {
    disengage("held for " + seconds(config_.safety.resume_time) + ": " + reason + "; engage again");
  }
}

ControllerOutput Controller::stopped() const {
  ControllerOutput output;
  output.state = engaged_ ? ControllerState::kHold : ControllerState::kIdle;
  output.reason = reason_;
  return output;
}

}  // namespace laparoscope_servo::servo
