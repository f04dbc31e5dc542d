#include "laparoscope_servo/sim/arm.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "laparoscope_servo/parameters/table.h"
#include "laparoscope_servo/validation/error_report.h"
#include "laparoscope_servo/validation/range.h"

namespace laparoscope_servo::sim {

namespace {

using aesop::JointVector;
using aesop::kDrivenJoints;
using aesop::kJoints;

constexpr double kStep = 0.002;  // s
constexpr double kAtRest =
    1e-4;  // m/s, rad/s: below this a joint without command counts as at rest, even without friction
constexpr double kLongest = 60.0;  // s of one hand movement
constexpr double kEpsilon = 1e-9;  // s

void checkFinite(const char* what, double value) {
  if (!std::isfinite(value)) {
    throw std::invalid_argument(std::string("emulated arm: ") + what + " = " + validation::numberText(value) +
                                ", expected a finite number");
  }
}

}  // namespace

void describe(parameters::Table& table, ArmConfig& c) {
  table.numbers("start", c.start.data(), kJoints, {-100, 100}, "m or rad",
                "joint positions at power-on; those of passive joints are a first guess");
  table.numbers("insertion_point", c.insertion_point.data(), 3, {-10, 10}, "m",
                "true position of the trocar in aesop_base");
  table.number("delay", c.delay, {0, 2}, "s", "from a command to its effect");
  table.numbers("dead_zone", c.dead_zone.data(), kJoints, {0, 1}, "m/s or rad/s",
                "of the joints; about 0.4 mm/s and 4 mrad/s of the scope");
  table.number("breakaway", c.breakaway, {1, 10}, "times", "factor on the dead zone for a joint to start from rest");
  table.number("time_constant", c.time_constant, {0, 1}, "s", "time constant with which a joint follows its speed");
}

std::vector<std::string> validate(const ArmConfig& config) {
  return parameters::errorsOf(config);
}

Arm::Arm(const aesop::Kinematics& kinematics, const ArmConfig& config) : kinematics_(kinematics), config_(config) {
  validation::throwErrors("emulated arm", validate(config));
  const aesop::WristSolution wrist = kinematics_.solveWrist(config.start, config.insertion_point);
  if (!wrist.ok) throw std::invalid_argument("emulated arm: start: " + wrist.reason);
  const std::string error = kinematics_.error(wrist.q);
  if (!error.empty()) throw std::invalid_argument("emulated arm: start: " + error);
  q_ = wrist.q;
}

void Arm::command(const std::array<double, kDrivenJoints>& speed, double now) {
  for (const double v : speed) checkFinite("speed", v);
  step(now);
  const double last = pending_.empty() ? now : pending_.back().at;
  pending_.push_back({std::max(last, now + config_.delay + lag_), speed});
}

void Arm::setGain(double gain) {
  checkFinite("gain", gain);
  gain_ = gain;
}

void Arm::setLag(double lag) {
  checkFinite("lag", lag);
  lag_ = lag;
}

void Arm::brake() {
  pending_.clear();
  target_ = {};
  hand_left_ = 0.0;
  qdot_.setZero();
  stuck_.clear();
}

std::string Arm::hand(const scope::Velocity& displacement, double seconds, double now) {
  step(now);
  if (!displacement.isFinite()) return "the displacement is not finite";
  if (!(seconds >= 0.0 && seconds <= kLongest)) return "seconds have to be a number from 0 to 60";
  if (isMoving()) return "the arm moves";
  const double duration = std::max(seconds, kStep);
  hand_ = {displacement.pan / duration, displacement.tilt / duration, displacement.spin / duration,
           displacement.insertion / duration};
  hand_left_ = duration;
  return "";
}

bool Arm::isMoving() const {
  const auto moves = [](const std::array<double, kDrivenJoints>& speed) {
    return std::any_of(speed.begin(), speed.end(), [](double v) { return v != 0.0; });
  };
  return isInHand() || !qdot_.isZero(0.0) || moves(target_) ||
         std::any_of(pending_.begin(), pending_.end(), [&](const Pending& p) { return moves(p.speed); });
}

void Arm::step(double now) {
  if (!started_) {
    now_ = now;
    started_ = true;
  }
  while (now_ + kEpsilon < now) {
    while (!pending_.empty() && pending_.front().at <= now_ + kEpsilon) {
      target_ = pending_.front().speed;
      pending_.pop_front();
    }
    double next = std::min(now, now_ + kStep);
    if (!pending_.empty()) next = std::min(next, std::max(pending_.front().at, now_ + kEpsilon));
    if (!isInHand() && qdot_.isZero(0.0) && target_ == std::array<double, kDrivenJoints>{}) {
      next = pending_.empty() ? now : std::min(now, std::max(pending_.front().at, now_ + kEpsilon));
    } else {
      advance(next - now_);
      if (!isInHand() && !qdot_.isZero(0.0)) moved_until_ = next;
    }
    now_ = next;
  }
}

JointVector Arm::drivenVelocity(double dt) const {
  JointVector velocity = JointVector::Zero();
  for (std::size_t k = 0; k < kDrivenJoints; ++k) {
    const int joint = kinematics_.driven()[k];
    if (joint == jammed_) continue;
    const double dead = config_.dead_zone[joint];
    const double threshold = qdot_[joint] == 0.0 ? config_.breakaway * dead : dead;
    const double gain = joint == reversed_ ? -gain_ : gain_;
    const double wanted = std::abs(target_[k]) > threshold ? gain * target_[k] : 0.0;
    const double share = config_.time_constant > 0.0 ? 1.0 - std::exp(-dt / config_.time_constant) : 1.0;
    const double next = qdot_[joint] + share * (wanted - qdot_[joint]);
    const bool rests = wanted == 0.0 && std::abs(next) <= std::max(dead, kAtRest);  // held by friction
    velocity[joint] = rests ? 0.0 : next;
  }
  return velocity;
}

JointVector Arm::handVelocity(double dt) {
  // Without the driver's limits: a hand can move the arm as far as the joints go.
  const aesop::JointMotion motion =
      aesop::jointMotion(kinematics_, aesop::MotionConfig(), q_, config_.insertion_point, hand_);
  const double share = std::min(1.0, hand_left_ / dt);
  hand_left_ = std::max(0.0, hand_left_ - dt);
  if (hand_left_ < kEpsilon) hand_left_ = 0.0;
  return motion.scale > 0.0 ? JointVector(share / motion.scale * motion.velocity) : JointVector(JointVector::Zero());
}

void Arm::advance(double dt) {
  if (dt <= 0.0) return;
  const bool in_hand = isInHand();
  const JointVector velocity = in_hand ? handVelocity(dt) : drivenVelocity(dt);
  JointVector next = q_;
  for (const int joint : kinematics_.driven()) {
    const aesop::DhJoint& limits = kinematics_.config().joints[static_cast<std::size_t>(joint)];
    next[joint] = std::min(limits.maximum, std::max(limits.minimum, q_[joint] + dt * velocity[joint]));
  }
  const aesop::WristSolution wrist = kinematics_.solveWrist(next, config_.insertion_point);
  if (!wrist.ok) {
    stuck_ = wrist.reason;
    qdot_.setZero();
    hand_left_ = 0.0;
    return;
  }
  qdot_ = (wrist.q - q_) / dt;
  // Rounding of the division must not leave a small velocity of a joint at rest.
  for (const int joint : kinematics_.driven()) {
    if (velocity[joint] == 0.0) qdot_[joint] = 0.0;
  }
  if (velocity.isZero(0.0)) qdot_.setZero();
  if (in_hand && !isInHand()) qdot_.setZero();  // a hand releases the arm at rest
  q_ = wrist.q;
}

}  // namespace laparoscope_servo::sim
