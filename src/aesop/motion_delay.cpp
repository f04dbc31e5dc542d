#include "laparoscope_servo/aesop/motion_delay.h"

#include <cmath>

#include "laparoscope_servo/robust/median.h"

namespace laparoscope_servo::aesop {

namespace {

constexpr std::size_t kSamples = 15;
constexpr double kConstant = 0.1;  // share by which a command may change and still counts as the same step

}  // namespace

void MotionDelay::sent(const JointVector& velocity, double now) {
  const bool moved = !sent_.isZero(0.0);
  const bool moves = !velocity.isZero(0.0);
  if (moves && !moved) {
    // Only when starting from rest does the motion belong to this command.
    const bool from_rest = still_ && phase_ == Phase::kNone;
    phase_ = Phase::kNone;
    if (from_rest) begin(Phase::kStarting, velocity, now);
  } else if (!moves && moved) {
    // A command that faded before it ended tells no moment from which to measure.
    const double changed = (sent_ - measured_).cwiseAbs().maxCoeff();
    const double speed = measured_.cwiseAbs().maxCoeff();
    const bool steady = phase_ == Phase::kNone && speed > 0.0 && changed <= kConstant * speed;
    phase_ = Phase::kNone;
    if (steady) begin(Phase::kStopping, measured_, now);
  } else if (phase_ == Phase::kStarting && std::abs(velocity[joint_] - speed_) > kConstant * std::abs(speed_)) {
    phase_ = Phase::kNone;
  }
  sent_ = velocity;
}

void MotionDelay::begin(Phase phase, const JointVector& velocity, double now) {
  phase_ = phase;
  velocity.cwiseAbs().maxCoeff(&joint_);
  speed_ = velocity[joint_];
  since_ = now;
  half_ = false;
}

void MotionDelay::received(const Status& status, double now) {
  measured_ = status.velocity;
  still_ = !status.moving;
  if (phase_ == Phase::kNone) return;
  const double share = status.velocity[joint_] / speed_;
  if (phase_ == Phase::kStarting) {
    if (!(share >= 0.5)) return;
    add(starts_, now - since_);
    phase_ = Phase::kNone;
    return;
  }
  if (!half_ && share <= 0.5) {
    half_ = true;
    add(stops_, now - since_);
  }
  if (still_) {
    add(standings_, now - since_);
    phase_ = Phase::kNone;
  }
}

void MotionDelay::lost() {
  phase_ = Phase::kNone;
  still_ = false;
  sent_.setZero();
  measured_.setZero();
}

void MotionDelay::add(Samples& samples, double value) {
  if (samples.size() == kSamples) samples.erase(samples.begin());
  samples.push_back(value);
}

std::optional<double> MotionDelay::median(const Samples& samples) {
  if (samples.empty()) return std::nullopt;
  Samples sorted = samples;
  return robust::median(sorted);
}

}  // namespace laparoscope_servo::aesop
