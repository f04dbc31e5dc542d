#include "laparoscope_servo/aesop/driver.h"

#include <sstream>
#include <stdexcept>

namespace laparoscope_servo::aesop {

namespace {

void append(const std::string& group, const std::vector<std::string>& errors, std::vector<std::string>& all) {
  for (const std::string& error : errors) all.push_back(group + "/" + error);
}

const DriverConfig& checked(const DriverConfig& config) {
  std::string text;
  for (const std::string& error : validate(config)) text += (text.empty() ? "" : "; ") + error;
  if (!text.empty()) throw std::invalid_argument("driver: " + text);
  return config;
}

std::uint8_t drivenMask(const Kinematics& kinematics) {
  unsigned mask = 0;
  for (const int joint : kinematics.driven()) mask |= 1u << joint;
  return static_cast<std::uint8_t>(mask);
}

std::string insertionPointError(const Eigen::Vector3d& point) {
  if (point.norm() < 10.0) return "";
  std::ostringstream text;
  text << "insertion_point = (" << point.transpose() << "), expected finite numbers within 10 m";
  return text.str();
}

}  // namespace

std::vector<std::string> validate(const DriverConfig& config) {
  std::vector<std::string> errors;
  append("kinematics", validate(config.kinematics), errors);
  append("motion", validate(config.motion), errors);
  append("command", validate(config.command), errors);
  append("link", validate(config.session), errors);
  const std::string point = insertionPointError(config.insertion_point);
  if (!point.empty()) errors.push_back(point);
  return errors;
}

Driver::Driver(const DriverConfig& config)
    : kinematics_(checked(config).kinematics),
      motion_(config.motion),
      insertion_point_(config.insertion_point),
      guard_(config.command),
      session_(config.session, drivenMask(kinematics_)) {}

std::string Driver::enable(double stamp_now, double now) {
  guard_.reset(stamp_now);
  refusal_.clear();
  return session_.enable(now);
}

std::string Driver::resume(double stamp_now) {
  guard_.reset(stamp_now);
  return session_.resume();
}

std::string Driver::command(const ScopeVelocity& velocity, double stamp, double stamp_now, double now) {
  refusal_ = guard_.accept(velocity, stamp, stamp_now, now);
  return refusal_;
}

std::string Driver::setInsertionPoint(const Eigen::Vector3d& point) {
  const std::string error = insertionPointError(point);
  if (!error.empty()) return error;
  const OperatingState state = session_.state();
  if (state.mode != OperatingMode::kDisabled) return std::string("the arm is ") + name(state.mode) + ", not DISABLED";
  if (state.is_busy) return "the arm moves, or is about to be enabled";
  insertion_point_ = point;
  return "";
}

OperatingState Driver::state(double now) const {
  OperatingState state = session_.state();
  if (state.mode != OperatingMode::kEnabled || !state.reason.empty()) return state;
  if (!refusal_.empty()) {
    state.reason = "command refused: " + refusal_;
  } else if (guard_.timedOut(now)) {
    state.reason = "the last command has run out";
  } else {
    state.reason = last_motion_.reason;
  }
  return state;
}

Bytes Driver::transmit(double now) {
  std::array<double, kDrivenJoints> speed{};
  last_motion_ = JointMotion();
  if (session_.isEnabled()) {
    last_motion_ =
        jointMotion(kinematics_, motion_, session_.link().status()->position, insertion_point_, guard_.velocity(now));
    for (std::size_t k = 0; k < speed.size(); ++k) speed[k] = last_motion_.velocity[kinematics_.driven()[k]];
  }
  return session_.transmit(speed, now);
}

}  // namespace laparoscope_servo::aesop
