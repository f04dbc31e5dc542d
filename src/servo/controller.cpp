#include "laparoscope_servo/servo/controller.h"

#include <algorithm>
#include <stdexcept>

namespace laparoscope_servo::servo {

namespace {

ControllerConfig checked(const ControllerConfig& config) {
  std::string text;
  for (const std::string& error : validate(config)) text += (text.empty() ? "" : "; ") + error;
  if (!text.empty()) throw std::invalid_argument("controller: " + text);
  return config;
}

SafetyFacts facts(const ControllerInput& input) {
  SafetyFacts facts;
  facts.time = input.time;
  facts.clock_jump = input.clock_jump;
  facts.residual = input.residual;
  facts.robot = input.robot;
  facts.pose = {input.depth.problem, input.depth.age, input.depth.d2, input.depth.lateral_offset};
  const TaskErrorInput& task = input.task_error;
  facts.tracker = {task.problem, task.age, task.image_age, task.valid, task.visible_fraction, task.corner_error};
  if (task.problem.empty() && task.valid && !isFinite(task.error)) facts.tracker.problem = "task error is not finite";
  facts.dead_man = input.dead_man;
  return facts;
}

// What occlusion and poor confidence leave of a velocity.
ScopeVelocity restrained(const ScopeVelocity& wanted, const SafetyOutput& safety, const Limits& limits) {
  Eigen::Vector4d velocity = wanted.vector();
  if (safety.speed_scale < 1.0) {
    // A share of what the limits leave: otherwise one far beyond them would not be slowed.
    const double excess = velocity.cwiseAbs().cwiseQuotient(limits.velocity.vector()).maxCoeff();
    velocity *= safety.speed_scale / std::max(1.0, excess);
  }
  ScopeVelocity result = ScopeVelocity::fromVector(velocity);
  if (!safety.insertion_allowed) result.insertion = std::min(result.insertion, 0.0);
  return result;
}

}  // namespace

Controller::Controller(const ControllerConfig& config)
    : config_(checked(config)),
      law_(std::make_unique<PaperLaw>(config.gains)),
      dead_zone_(config.dead_zone),
      limiter_(config.limits),
      machine_(config.safety) {}

std::string Controller::engage(const ControllerInput& input) {
  if (engaged()) return "";
  const std::string refusal = problem(input);
  if (!refusal.empty()) return refusal;
  SafetyFacts request = facts(input);
  request.request = EngageRequest::kOn;
  machine_.step(request);
  has_time_ = false;  // the pause since the last step is no step
  last_time_ = input.time;
  rest();
  return "";
}

void Controller::disengage(const std::string& reason) {
  SafetyFacts request;
  request.time = last_time_;
  request.request = EngageRequest::kOff;
  request.off_reason = reason;
  machine_.step(request);
  rest();
}

std::string Controller::problem(const ControllerInput& input) const {
  return machine_.refusal(facts(input));
}

ControllerOutput Controller::update(const ControllerInput& input) {
  SafetyFacts known = facts(input);
  SafetyOutput safety = machine_.step(known);
  ControllerOutput output;
  if (safety.state == ControllerState::kServo) {
    output.command = servo(input, safety);
    known.command_finite = output.command.vector().allFinite();
    if (!known.command_finite) {
      safety = machine_.step(known);
      output.command = ScopeVelocity();
    }
  }
  if (safety.reset_history) rest();
  last_time_ = input.time;
  has_time_ = true;
  output.state = safety.state;
  output.reason = safety.reason;
  output.caution = safety.caution;
  output.speed_scale = safety.speed_scale;
  return output;
}

ScopeVelocity Controller::servo(const ControllerInput& input, const SafetyOutput& safety) {
  const double dt = has_time_ ? std::min(input.time - last_time_, config_.safety.max_period) : 0.0;
  const ScopeVelocity wanted = law_->velocity(input.task_error.error, input.depth.d2);
  if (!wanted.vector().allFinite()) return wanted;
  return limiter_.apply(dead_zone_.apply(restrained(wanted, safety, config_.limits)), dt);
}

void Controller::rest() {
  dead_zone_.reset();
  limiter_.reset();
}

}  // namespace laparoscope_servo::servo
