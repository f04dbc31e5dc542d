#include "servo/controller_implementation.h"

#include <algorithm>
#include <cmath>

#include "laparoscope_servo/validation/error_report.h"
#include "servo/shaping/dead_zone.h"

namespace laparoscope_servo::servo {

namespace {

ControllerConfig checked(const ControllerConfig& config) {
  validation::throwErrors("controller", validate(config));
  return config;
}

// Share of the effect budget at which the scope stops. Derived: one more step, 0.02 s at 0.1 rad/s, is 4 % of 0.044 rad
// (effect/unconfirmed_turn). It stops at once instead of slowing down, since fast motion shows its effect better than
// slow motion.
constexpr double kUsedUp = 0.97;
// Spin and insertion do not reveal a fault of pan and tilt. From the share kSlowerAside of their budget on they are
// slowed down, to kSlowest of their speed at least, so that the effect of pan and tilt is confirmed first.
constexpr double kSlowerAside = 0.8;
constexpr double kSlowest = 0.1;

// Facts for the task MANUAL, which does not need the tracker: all of it counts as present.
TrackerFacts nothingMissing() {
  TrackerFacts facts;
  facts.problem.clear();
  facts.valid = true;
  facts.age = facts.image_age = facts.corner_error = 0.0;
  facts.visible_fraction = 1.0;
  return facts;
}

std::optional<InsertionPointPrior> priorOf(const InsertionPointUse& config) {
  if (!(config.prior_stddev > 0.0)) return std::nullopt;
  return InsertionPointPrior{Eigen::Vector3d::Zero(), config.prior_stddev};
}

}  // namespace

Controller::Implementation::Implementation(const ControllerConfig& config)
    : config_(checked(config)),
      servo_(config),
      machine_(config.safety),
      stick_(config.safety, config.limits.velocity),
      tip_(config.centre_tip.dwell, config.centre_tip.still),
      parallel_(config.parallel, config.range, config.features.desired_depth),
      repeats_(config.safety.max_repeated_errors),
      effect_(config.effect, {config.target.centre_noise, config.target.depth_noise, config.target.orientation_noise}),
      opposed_(config.dead_zone.width),
      leash_(config.leash),
      insertion_point_(config.insertion_point.estimator, priorOf(config.insertion_point)),
      d2_correction_(config.insertion_point.correction_rate) {}

SafetyFacts Controller::Implementation::facts(const ControllerInput& input) const {
  SafetyFacts facts;
  facts.time = input.time;
  facts.clock_jump = input.clock_jump;
  facts.ended = input.ended;
  facts.residual = insertion_point_.residualLevel();
  facts.robot = input.robot;
  facts.pose = {input.depth.problem, input.depth.age, d2(input), input.depth.lateral_offset,
                std::abs(d2_correction_.wanted())};
  facts.dead_man = input.dead_man;
  if (engaged() && config_.effect.enabled) facts.effect = effectFacts();
  if (engaged()) facts.wandered = leash_.words();
  if (task_ == Task::kManual) {
    facts.tracker = nothingMissing();
    return facts;
  }
  const TaskErrorInput& task = seen(input);
  facts.tracker = {task.problem,      task.age,
                   task.image_age,    task.valid,
                   task.region,       task.visible_fraction,
                   task.corner_error, usual_age_.share(task.image_age)};
  if (task.problem.empty() && task.valid) facts.tracker.problem = problemOf(task);
  if (task_ == Task::kParallel && facts.tracker.problem.empty()) facts.tracker.problem = planeProblem(input);
  return facts;
}

EffectFacts Controller::Implementation::effectFacts() const {
  if (!opposed_.words().empty()) return {Effect::kWrong, opposed_.words()};
  if (task_ == Task::kManual) return {};  // what the picture shows does not count
  if (effect_.effect() == Effect::kAsCommanded && !(effect_.budget().spent() < kUsedUp))
    return {Effect::kDoubted, "the picture has not yet shown what the motion of the scope does"};
  return {effect_.effect(), effect_.words()};
}

// Uses the estimated d2; the calibration is its prior, so without information from the poses both are equal.
double Controller::Implementation::d2(const ControllerInput& input) const {
  return input.depth.d2 + d2_correction_.value();
}

void Controller::Implementation::correctDepth(const ControllerInput& input) {
  const InsertionPointEstimate& estimate = insertion_point_.estimate();
  double wanted = 0.0;
  if (config_.insertion_point.use && input.depth.insertion_point_T_tip && estimate.valid) {
    const Eigen::Isometry3d& tip = *input.depth.insertion_point_T_tip;
    wanted = shaftDepth(estimate, {tip.translation(), tip.linear().col(2)}, 0.0).d2 - input.depth.d2;
  }
  d2_correction_.update(input.time, wanted);
}

std::string Controller::Implementation::engage(const ControllerInput& input) {
  if (engaged()) return "";
  const std::string refusal = problem(input);
  if (!refusal.empty()) return refusal;
  SafetyFacts request = facts(input);
  request.request = EngageRequest::kOn;
  machine_.step(request);
  if (task_ == Task::kParallel) parallel_.engage(input.time);
  effect_.rearm();
  opposed_.restart();
  leash_.restart();
  has_time_ = false;  // the pause since the last step is not a period
  last_time_ = input.time;
  servo_.reset();
  stick_.restart();
  return "";
}

void Controller::Implementation::end(const std::string& reason, double time) {
  SafetyFacts request;
  request.time = time;
  request.request = EngageRequest::kOff;
  request.off_reason = reason;
  machine_.step(request);
  servo_.reset();
}

void Controller::Implementation::select(Task task) {
  if (task == task_) return;
  task_ = task;
  task_changed_ = true;
  stick_.restart();
  leash_.restart();
  parallel_.restart();
  keyed_view_.restart();
  usual_age_.restart();
  effect_.anotherTracker();
  servo_.setUse(servoUse(task, config_));
  servo_.restart(last_time_);
}

std::string Controller::Implementation::problem(const ControllerInput& input) const {
  return machine_.refusal(facts(input));
}

ControllerOutput Controller::Implementation::update(const ControllerInput& input) {
  if (input.robot_report.present) {
    servo_.report(input.time - input.robot_report.age, input.robot_report.velocity);
    effect_.report(input.time - input.robot_report.age, input.robot_report.velocity);
    opposed_.report(input.time - input.robot_report.age, input.robot_report.velocity, servo_.history(), servo_.delay());
  }
  if (!input.clock_jump.empty()) insertion_point_.reset();
  // Poses are not used if they repeat the last one, or if the scope is not in the body.
  const bool poses_count = input.depth.problem.empty() && input.depth.pose_is_new && input.depth.d2 > 0.0 &&
                           input.depth.age <= config_.safety.max_depth_age &&
                           input.depth.lateral_offset <= config_.safety.max_lateral_offset;
  if (config_.insertion_point.use && poses_count && input.depth.insertion_point_T_tip) {
    const Eigen::Isometry3d& tip = *input.depth.insertion_point_T_tip;
    insertion_point_.update(input.time, {tip.translation(), tip.linear().col(2)});
  }
  correctDepth(input);
  watchRepetition(seen(input));
  watchAge(seen(input), input.time);
  watchEffect(input);
  watchLeash(input);
  watchTip(input.tip);
  watchPlane(input);
  // A non-finite time is ignored here, and the budget stays; the state machine stops the scope.
  const bool has_clock = std::isfinite(input.time);
  const double told_for = std::clamp(input.time - last_time_, 0.0, config_.predictor.command_lifetime);
  if (has_clock) effect_.command(told_for * told_, task_ != Task::kManual);
  SafetyFacts known = facts(input);
  SafetyOutput safety = machine_.step(known);
  ControllerOutput output;
  const bool moves = safety.state == ControllerState::kServo && !task_changed_;
  const std::string stick = stick_.update(input.manual, moves && task_ == Task::kManual, input.time);
  if (moves) {
    output.command = task_ == Task::kManual ? drive(input, stick) : follow(input, safety);
    known.command_finite = output.command.vector().allFinite();
    if (!known.command_finite) {
      safety = machine_.step(known);
      output.command = scope::Velocity();
    }
  }
  if (safety.reset_history) servo_.stop(input.time);
  told_ = afterDeadZone(output.command, config_.dead_zone.width).vector();
  const bool noticed = (output.command.vector().cwiseAbs().array() > config_.dead_zone.width.vector().array()).any();
  if (!noticed) moves_since_.reset();
  if (noticed && !moves_since_) moves_since_ = input.time;
  if (has_clock) last_time_ = input.time;
  has_time_ = has_clock;
  task_changed_ = false;
  output.task = task_;
  output.state = safety.state;
  output.reason = safety.reason;
  output.caution = caution(safety, stick);
  output.speed_scale = safety.speed_scale;
  return output;
}

ControllerFigures Controller::Implementation::figures() const {
  ControllerFigures figures;
  figures.insertion_point = insertion_point_.estimate();
  figures.insertion_point_residual = insertion_point_.residual();
  figures.delay = servo_.delay();
  figures.breathing_rate = servo_.breathingRate();
  figures.gain_factor = servo_.gainFactor();
  figures.evidence = effect_.evidence();
  figures.unconfirmed = effect_.budget().spent();
  figures.leash = leash_.used();
  figures.parallel = parallel_.figures();
  return figures;
}

std::string Controller::Implementation::caution(const SafetyOutput& safety, const std::string& stick) const {
  if (safety.state != ControllerState::kServo) return safety.caution;
  std::string text = safety.caution;
  if (text.empty() && task_ == Task::kParallel && parallel_.stage() == ParallelStage::kSettles)
    text = "the circle is done: the scope waits until the arm stands";
  if (text.empty() && servo_.atBound()) text = "the scope is at a bound of its range: depths or cone";
  if (text.empty() && servo_.blocked()) text = "the robot does not do what it is told";
  if (!stick.empty()) text += (text.empty() ? "" : "; ") + stick;
  return text;
}

ServoLimits Controller::Implementation::limits(const SafetyOutput& safety, double time) const {
  ServoLimits limits{safety.speed_scale, safety.insertion_allowed};
  if (!config_.effect.enabled) return limits;
  constexpr double kSeen = 0.1;  // s, until the effect of a motion is observed and judged
  if (!effect_.confirmed()) limits.insertion = 0.5 * config_.effect.unconfirmed_insertion / (servo_.delay() + kSeen);
  // Without commanded pan or tilt there is no effect of theirs to verify.
  if (told_.head<2>().isZero(0.0)) return limits;
  const double left = std::clamp((1.0 - effect_.budget().aside()) / (1.0 - kSlowerAside), kSlowest, 1.0);
  if (left >= 1.0) return limits;
  const double step = has_time_ ? std::min(time - last_time_, config_.safety.max_period) : 0.0;
  const Eigen::Vector4d slowed = told_.cwiseAbs() - step * config_.limits.acceleration.vector();
  limits.spin = std::max(slowed[2], left * config_.limits.velocity.spin);
  limits.insertion = std::min(limits.insertion, std::max(slowed[3], left * config_.limits.velocity.insertion));
  return limits;
}

ServoInput Controller::Implementation::servoInput(const ControllerInput& input) const {
  ServoInput servo;
  servo.time = input.time;
  const TaskErrorInput& task = seen(input);
  servo.image_time = task.image_time.value_or(input.time - task.image_age);
  servo.error = task.error;
  servo.region = task.region;
  servo.scope = {input.depth.camera_R_shaft, d2(input)};
  servo.d2_doubt = std::abs(d2_correction_.wanted());
  servo.pose_time = input.time - input.depth.age;
  servo.insertion_point_T_tip = input.depth.insertion_point_T_tip;
  servo.period = has_time_ ? std::min(input.time - last_time_, config_.safety.max_period) : 0.0;
  if (task_ == Task::kParallel && parallel_.stage() == ParallelStage::kTurn) {
    servo.error = parallel_.error();
    servo.image_time = servo.pose_time = parallel_.errorTime();
  }
  return servo;
}

scope::Velocity Controller::Implementation::follow(const ControllerInput& input, const SafetyOutput& safety) {
  if (task_ == Task::kCentreTip && told_.isZero(0.0) && !tip_.isStill()) {
    servo_.stop(input.time);
    return scope::Velocity();
  }
  if (task_ == Task::kParallel) return faceTissue(input, safety);
  return servo_.command(servoInput(input), limits(safety, input.time));
}

scope::Velocity Controller::Implementation::drive(const ControllerInput& input, const std::string& problem) {
  if (!problem.empty()) {
    servo_.stop(input.time);
    return scope::Velocity();
  }
  return servo_.drive(servoInput(input), stick_.deflection(input.manual.velocity));
}

}  // namespace laparoscope_servo::servo
