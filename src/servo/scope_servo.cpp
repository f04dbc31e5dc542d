#include "servo/scope_servo.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "servo/shaping/dead_zone.h"
#include "servo/shaping/workspace.h"
#include "servo/task/horizon.h"

namespace laparoscope_servo::servo {

namespace {

constexpr double kSameImage = 1e-6;  // s, rounding
constexpr double kBlocked = 0.3;     // s: a robot that does not execute commands for longer counts as blocked
// s: more than the largest image age (1 s), delay (1 s) and lifetime of a command (2 s) together
constexpr double kHistory = 5.0;

// Reduces the limits by the dead zone, whose inverse is applied after them.
Limits beforeDeadZone(const ControllerConfig& config) {
  Limits limits = config.limits;
  if (!config.dead_zone.inverse) return limits;
  limits.velocity = scope::Velocity::fromVector(limits.velocity.vector() - config.dead_zone.width.vector());
  return limits;
}

DelayConfig delayConfig(const PredictorConfig& predictor) {
  DelayConfig config;
  config.initial = predictor.delay;
  config.minimum = predictor.min_delay;
  config.maximum = predictor.max_delay;
  return config;
}

scope::Velocity scaled(const scope::Velocity& velocity, double scale) {
  return scope::Velocity::fromVector(scale * velocity.vector());
}

}  // namespace

ScopeServo::ScopeServo(const ControllerConfig& config)
    : config_(config),
      use_(servoUse(Task::kHoldView, config)),
      paper_law_(config.gains),
      feature_law_(config.features, use_.axes()),
      band_(config.rest),
      oscillation_(config.oscillation),
      limiter_(beforeDeadZone(config)),
      history_(kHistory, config.predictor.command_lifetime),
      delay_(delayConfig(config.predictor)),
      target_(config.target),
      breathing_(config.breathing, config.target) {}

const ControlLaw& ScopeServo::law() const {
  if (use_.law == LawKind::kPaper) return paper_law_;
  return feature_law_;
}

void ScopeServo::retune(const ControllerConfig& config) {
  config_.gains = config.gains;
  config_.features.centre = config.features.centre;
  config_.features.depth = config.features.depth;
  config_.features.orientation = config.features.orientation;
  paper_law_ = PaperLaw(config_.gains);
  feature_law_ = FeatureLaw(config_.features, use_.axes());
  RestConfig rest = config.rest;
  rest.enabled = config_.rest.enabled;
  config_.rest = rest;
  if (!use_.rest) band_.retune(rest);
  target_.setSignificance(config.target.significance);
}

void ScopeServo::reset() {
  limiter_.reset();
  history_.clear();
  delay_.reset(false);
  forgetTarget();
}

void ScopeServo::setUse(const ServoUse& use) {
  use_ = use;
  feature_law_ = FeatureLaw(config_.features, use_.axes());
  band_.retune(use_.rest.value_or(config_.rest));
}

void ScopeServo::restart(double time) {
  stop(time);
  forgetTarget();
}

void ScopeServo::forgetTarget() {
  band_.reset();
  oscillation_.reset();
  target_.reset();
  breathing_.reset();
  has_image_ = false;
  turn_ = 0.0;
  displacement_.setZero();
}

void ScopeServo::stop(double time) {
  at_bound_ = false;
  band_.reset();
  limiter_.reset();
  remember(time, scope::Velocity());
}

// `executed`: velocity after the delay has passed.
void ScopeServo::remember(double time, const scope::Velocity& executed) {
  history_.add(time, executed);
  delay_.command(time, executed);
}

void ScopeServo::report(double time, const scope::Velocity& velocity) {
  delay_.report(time, velocity);
  const Eigen::Vector4d told = history_.velocity(time, delay()), done = velocity.vector();
  bool differs = false;
  for (int k = 0; k < 4; ++k) {
    const bool fast = std::abs(told[k]) > 2.0 * config_.dead_zone.width.vector()[k] && told[k] != 0.0;
    differs |= fast && !(done[k] * told[k] > 0.25 * told[k] * told[k]);
  }
  if (!differs || time < blocked_since_) blocked_since_ = time;
  blocked_ = time - blocked_since_ > kBlocked;
}

// One of the two spans is empty.
Eigen::Vector4d ScopeServo::sinceImage(const ServoInput& input) const {
  return history_.displacement(input.image_time, input.pose_time, delay()) -
         history_.displacement(input.pose_time, input.image_time, delay());
}

// The task error, with the ROI's orientation replaced by the horizon's (kUpright) or by zero (kReleased).
TaskError ScopeServo::oriented(const ServoInput& input) const {
  TaskError error = input.error;
  if (use_.spin == SpinMode::kServo) return error;
  error.alpha = error.desired_alpha = 0.0;
  error.e_w.setZero();
  if (use_.spin == SpinMode::kReleased || !input.insertion_point_T_tip) return error;
  const Eigen::Vector3d up(config_.horizon.up[0], config_.horizon.up[1], config_.horizon.up[2]);
  const auto since = scope::Velocity::fromVector(sinceImage(input));
  const Eigen::Matrix3d pose_R_image = geometry::so3Exp(-scope::angularVelocity(since));
  const Eigen::Matrix3d base_R_shaft = input.insertion_point_T_tip->linear() * pose_R_image;
  error.alpha = horizonError(input.scope.camera_R_shaft * base_R_shaft.transpose() * up);
  return error;
}

// Velocity of the scope that follows this velocity of the target.
scope::Velocity ScopeServo::following(const Features& velocity) const {
  return scope::Velocity::fromVector(inverseOf(jacobian_, use_.axes()) * velocity);
}

void ScopeServo::observe(const ServoInput& input) {
  const Eigen::Vector2d desired(input.error.desired_x, input.error.desired_y);
  if (has_image_ && (desired != desired_ || input.error.m_star != m_star_ || input.region != region_))
    restart(input.time);  // another region was selected
  region_ = input.region;
  desired_ = desired;
  m_star_ = input.error.m_star;
  error_ = oriented(input);
  if (!has_image_) {
    jacobian_ =
        featureJacobian(input.error.desired_x, input.error.desired_y, config_.features.desired_depth, input.scope);
  }
  const Eigen::Vector4d executed = has_image_ ? history_.displacement(image_time_, input.image_time, delay())
                                              : Eigen::Vector4d(Eigen::Vector4d::Zero());
  displacement_ += executed;
  to_target_ = displacementToTarget(error_, input.scope, config_.features.desired_depth);
  image_time_ = input.image_time;
  has_image_ = true;
  // A hand that works about the zone's middle is no oscillation of the loop, and no breath.
  if (!use_.is_tissue) return;
  TaskError controlled = error_;
  if (!use_.insertion) controlled.log_depth = controlled.desired_log_depth;
  oscillation_.update(image_time_, controlled);
  if (!to_target_.allFinite()) return;
  const Features place = jacobian_ * (displacement_ + to_target_);
  // If the scope does not execute its commands, a target at rest looks as if it moved along with the scope.
  if (breathing_.observe(image_time_, place) || blocked_) target_.reset();
  target_.observe(image_time_, place - breathing_.predict(image_time_).place, jacobian_ * executed);
}

scope::Velocity ScopeServo::command(const ServoInput& input, const ServoLimits& limits) {
  if (!has_image_ || std::abs(input.image_time - image_time_) > kSameImage) observe(input);
  TaskError error = error_;
  scope::Velocity follow;
  if (config_.predictor.enabled) {
    // The command is executed from `input.time + delay` on, for a period T, and is constant meanwhile. The laws are
    // made for a velocity that changes with the error all the time: v(t) = -K e(t). Its mean over the period is its
    // value in the middle, but for an error of order T^2; at the beginning it would be T / 2 too early. Up to there
    // the scope goes on by the last command, which differs from this one by order T. For a single gain K: from
    // v_k = -K (e_k + T / 2 v_k-1) and e_k+1 = e_k + T v_k, a period leaves 1 - KT + (KT)^2 / 2 of the error, and
    // exp(-KT) would be left to second order; without the T / 2, it is 1 - KT. This holds for what the scope still
    // does and for the target's motion alike.
    const double middle = input.time + delay() + 0.5 * input.period;
    const Eigen::Vector4d under_way = history_.displacement(image_time_, middle, delay());
    Eigen::Vector4d displacement = under_way;  // if the displacement to the target is unknown: as for a target at rest
    if (use_.is_tissue && to_target_.allFinite() && !target_.empty()) {
      const TargetPrediction breath = breathing_.predict(middle);
      const TargetPrediction target = target_.predict(middle);
      const Eigen::Matrix4d inverse = jacobian_.inverse();
      displacement = to_target_ - (inverse * (target.place + breath.place) - (displacement_ + under_way));
      // After an oscillation the target velocity is not fed forward: it may be the loop's own motion. Breathing is no
      // such motion.
      Features velocity = breath.velocity;
      if (!(gainFactor() < 1.0)) velocity += target.velocity;
      if (config_.predictor.feed_forward) follow = following(velocity);
    }
    error = moved(error, displacement, input.scope, config_.features.desired_depth);
  }
  if (!follow.vector().allFinite()) return follow;
  // Near half a turn both ways round are about equally long: the scope keeps to the one that it has begun.
  const double turn = error.alpha - error.desired_alpha;
  const double same_way = turn_ + std::remainder(turn - turn_, 2.0 * M_PI);
  turn_ = shortTurn(same_way);
  error.alpha = error.desired_alpha + turn_;
  const bool follows = follow.vector() != Eigen::Vector4d::Zero();
  const LawVelocity wanted = law().velocity(follows ? error : band_.apply(error, input.time), input.scope);
  if (!wanted.sum().vector().allFinite()) return wanted.sum();
  const double gain = limits.scale * gainFactor();
  // Pan and tilt come first, so that the limits of spin and insertion do not slow down the centring. Spin and insertion
  // are limited separately, since a slow axis delays the verification of its direction.
  scope::Velocity centring = scaled(wanted.centring, gain), spin, insertion;
  std::swap(centring.spin, spin.spin);
  std::swap(centring.insertion, insertion.insertion);
  scope::Velocity velocity =
      limiter_.apply({scaled(follow, limits.scale), scaled(wanted.turning, gain), centring, spin, insertion},
                     input.period, limits.scale);
  velocity.insertion = std::clamp(velocity.insertion, -limits.insertion, limits.insertion);
  velocity.spin = std::clamp(velocity.spin, -limits.spin, limits.spin);
  if (!limits.insertion_allowed) velocity.insertion = std::min(velocity.insertion, 0.0);
  return send(input, velocity);
}

scope::Velocity ScopeServo::drive(const ServoInput& input, const scope::Velocity& wanted) {
  return send(input, limiter_.apply(wanted, input.period));
}

scope::Velocity ScopeServo::send(const ServoInput& input, scope::Velocity velocity) {
  const Eigen::Vector4d free = velocity.vector();
  const double d2 = input.scope.d2 + std::copysign(input.d2_doubt, velocity.insertion);
  velocity = input.insertion_point_T_tip ? within(config_.range, velocity, d2, input.insertion_point_T_tip->linear())
                                         : within(config_.range, velocity, d2);
  at_bound_ = velocity.vector() != free;
  limiter_.applied(velocity);
  const scope::Velocity command =
      config_.dead_zone.inverse ? throughDeadZone(velocity, config_.dead_zone.width) : velocity;
  remember(input.time, afterDeadZone(command, config_.dead_zone.width));
  return command;
}

}  // namespace laparoscope_servo::servo
