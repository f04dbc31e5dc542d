#include "laparoscope_servo/aesop/driver.h"

#include <cmath>
#include <sstream>

#include "laparoscope_servo/validation/error_report.h"

namespace laparoscope_servo::aesop {

namespace {

const DriverConfig& checked(const DriverConfig& config) {
  validation::throwErrors("driver", validate(config));
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
  validation::addGroup("kinematics", validate(config.kinematics), errors);
  validation::addGroup("motion", validate(config.motion), errors);
  validation::addGroup("command", validate(config.command), errors);
  validation::addGroup("link", validate(config.session), errors);
  validation::addGroup("monitor", validate(config.monitor), errors);
  const std::string point = insertionPointError(config.insertion_point);
  if (!point.empty()) errors.push_back(point);
  return errors;
}

Driver::Driver(const DriverConfig& config)
    : kinematics_(checked(config).kinematics),
      motion_(config.motion),
      insertion_point_(config.insertion_point),
      guard_(config.command),
      session_(config.session, drivenMask(kinematics_)),
      monitor_(config.monitor, kinematics_) {}

void Driver::record(WireEvent event, Bytes payload) {
  if (tap_ != nullptr) tap_->take({event, tap_time_, std::move(payload)});
}

void Driver::record(WireEvent event, double now, Bytes payload) {
  tap_time_ = std::llround(now * 1e9);
  record(event, std::move(payload));
}

std::string Driver::enable(double stamp_now, double now) {
  if (tap_ != nullptr) record(WireEvent::kEnable, now, payloadOf({stamp_now}));
  guard_.reset(stamp_now);
  refusal_.clear();
  return session_.enable(now);
}

std::string Driver::disable(double now) {
  record(WireEvent::kDisable, now);
  return session_.disable(now);
}

std::string Driver::stop(double now, const std::string& reason) {
  if (tap_ != nullptr) record(WireEvent::kDisable, now, payloadOf(reason));
  return session_.stop(now, reason);
}

std::string Driver::clearFault(double now) {
  record(WireEvent::kClearFault, now);
  return session_.clearFault(now);
}

std::string Driver::pause(const std::string& reason) {
  if (tap_ != nullptr) record(WireEvent::kPause, payloadOf(reason));
  return session_.pause(reason);
}

std::string Driver::resume(double stamp_now) {
  if (tap_ != nullptr) record(WireEvent::kResume, payloadOf({stamp_now}));
  guard_.reset(stamp_now);
  refusal_.clear();
  return session_.resume();
}

std::string Driver::command(const scope::Velocity& velocity, double stamp, double stamp_now, double now) {
  if (tap_ != nullptr) {
    record(WireEvent::kCommand, now,
           payloadOf({velocity.pan, velocity.tilt, velocity.spin, velocity.insertion, stamp, stamp_now}));
  }
  refusal_ = guard_.accept(velocity, stamp, stamp_now, now);
  // so that it has no effect either if the enable is confirmed within its timeout
  if (!session_.isEnabled()) guard_.forget();
  return refusal_;
}

void Driver::receive(const std::uint8_t* data, std::size_t size, double now) {
  if (tap_ != nullptr && size > 0) record(WireEvent::kReceived, now, Bytes(data, data + size));
  session_.receive(data, size, now);
  const Link& link = session_.link();
  // The link may have been lost and have come up again within this read.
  if (!link.isUp() || link.statistics().sessions != link_sessions_) {
    link_sessions_ = link.statistics().sessions;
    delay_.lost();
    monitor_.reset();
  }
  if (link.statistics().received == statuses_) return;
  statuses_ = link.statistics().received;
  if (link.isUp()) delay_.received(*link.status(), now);
  watchMotion(now);
}

void Driver::watchMotion(double now) {
  const OperatingMode mode = session_.state().mode;
  // While DISABLED the arm may be moved by hand.
  if (mode != OperatingMode::kEnabled && mode != OperatingMode::kPaused) return monitor_.reset();
  const std::string reason = monitor_.take(*session_.link().status(), speed_, now);
  if (!reason.empty()) session_.giveUp(reason);
}

std::string Driver::setInsertionPoint(const Eigen::Vector3d& point) {
  const std::string error = insertionPointError(point);
  if (!error.empty()) return error;
  const OperatingState state = session_.state();
  if (state.mode != OperatingMode::kDisabled) return std::string("the arm is ") + name(state.mode) + ", not DISABLED";
  if (state.is_busy) return "the arm moves, or is about to be enabled";
  if (tap_ != nullptr) record(WireEvent::kInsertionPoint, payloadOf({point.x(), point.y(), point.z()}));
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

void Driver::opened(double now) {
  // A recording whose beginning was deleted can be replayed from here on.
  const Eigen::Vector3d& point = insertion_point_;
  if (tap_ != nullptr) record(WireEvent::kInsertionPoint, now, payloadOf({point.x(), point.y(), point.z()}));
  record(WireEvent::kOpened, now);
  session_.opened(now);
}

void Driver::closed(const std::string& reason) {
  if (tap_ != nullptr) record(WireEvent::kClosed, payloadOf(reason));
  session_.closed(reason);
}

Bytes Driver::transmit(double now) {
  Bytes bytes = cycle(now);
  if (tap_ == nullptr) return bytes;
  record(WireEvent::kSent, now, bytes);
  Bytes state = payloadOf(this->state(now));
  if (state != tap_state_) record(WireEvent::kState, tap_state_ = std::move(state));
  return bytes;
}

Bytes Driver::cycle(double now) {
  std::array<double, kDrivenJoints> speed{};
  last_motion_ = JointMotion();
  if (session_.isEnabled()) {
    last_motion_ =
        jointMotion(kinematics_, motion_, session_.link().status()->position, insertion_point_, guard_.velocity(now));
    for (std::size_t k = 0; k < speed.size(); ++k) speed[k] = last_motion_.velocity[kinematics_.driven()[k]];
  }
  speed_ = speed;
  const Bytes bytes = session_.transmit(speed, now);
  if (!bytes.empty()) delay_.sent(session_.isMoving() ? last_motion_.velocity : JointVector::Zero(), now);
  return bytes;
}

}  // namespace laparoscope_servo::aesop
