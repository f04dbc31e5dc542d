#include "laparoscope_servo/aesop/session.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace laparoscope_servo::aesop {

namespace {

constexpr const char* kUnconfirmed = "the controller does not confirm the disable";

bool isFault(const Status& status) {
  return status.state == RobotState::kFault || status.faults != 0;
}

std::string faultText(const Status& status) {
  const std::string faults = describeFaults(status.faults);
  return "fault: " + (faults.empty() ? std::string("the controller names no cause") : faults);
}

}  // namespace

const char* name(OperatingMode mode) {
  switch (mode) {
    case OperatingMode::kDisabled:
      return "DISABLED";
    case OperatingMode::kEnabled:
      return "ENABLED";
    case OperatingMode::kPaused:
      return "PAUSED";
    case OperatingMode::kFault:
      return "FAULT";
  }
  return "unknown";
}

Bytes payloadOf(const OperatingState& state) {
  Bytes bytes(2 + state.reason.size());
  bytes[0] = static_cast<std::uint8_t>(state.mode);
  bytes[1] = static_cast<std::uint8_t>((state.is_homed ? 1 : 0) + (state.is_busy ? 2 : 0));
  std::copy(state.reason.begin(), state.reason.end(), bytes.begin() + 2);
  return bytes;
}

OperatingState stateOf(const Bytes& payload) {
  if (payload.size() < 2 || payload[0] > static_cast<std::uint8_t>(OperatingMode::kFault) || payload[1] > 3) {
    throw std::invalid_argument("a state that is none");
  }
  return {static_cast<OperatingMode>(payload[0]), (payload[1] & 1) != 0, (payload[1] & 2) != 0,
          std::string(payload.begin() + 2, payload.end())};
}

std::string Session::enable(double now) {
  if (!link_.isUp()) return "not connected: " + link_.reason();
  if (!link_.status()) return "not connected: the controller has not sent its status yet";
  if (isFault(*link_.status())) return faultText(*link_.status()) + "; clear_fault comes first";
  if (!link_.status()->homed) return "the arm is not homed: its joint positions mean nothing";
  if (wish_ == Wish::kEnabled) return "";
  // The controller must come from DISABLED, so that what it did before cannot go on.
  if (link_.status()->state != RobotState::kDisabled) return "still disabling; try again";
  wish_ = Wish::kEnabled;
  confirmed_ = false;
  stopped_ = false;
  paused_ = false;
  urgent_ = true;
  request_sequence_ = link_.sequence();
  deadline_ = now + config_.request_timeout;
  reason_ = "enable asked for";
  return "";
}

std::string Session::stop(double now, const std::string& reason) {
  const std::string refusal = disable(now, reason);
  stopped_ = true;
  return refusal;
}

std::string Session::disable(double now, const std::string& reason) {
  drop(reason);
  stopped_ = false;
  askForDisable();
  disable_deadline_ = now + config_.request_timeout;
  return link_.isUp() ? "" : "not connected: " + link_.reason();
}

std::string Session::clearFault(double now) {
  if (!link_.isUp() || !link_.status()) return "not connected: " + link_.reason();
  if (!isFault(*link_.status())) return "there is no fault";
  clearing_ = true;
  urgent_ = true;
  deadline_ = now + config_.request_timeout;
  return "";
}

std::string Session::pause(const std::string& reason) {
  if (state().mode == OperatingMode::kPaused) return "";
  if (!isEnabled()) return "only an enabled arm can be paused";
  paused_ = true;
  urgent_ = true;
  reason_ = reason;
  return "";
}

std::string Session::resume() {
  if (state().mode != OperatingMode::kPaused) return "the arm is not paused";
  paused_ = false;
  reason_.clear();
  return "";
}

void Session::closed(const std::string& reason) {
  link_.closed(reason);
  drop(reason);
}

void Session::drop(const std::string& reason) {
  if (wish_ == Wish::kEnabled) {
    askForDisable();
    stopped_ = true;
  }
  wish_ = Wish::kDisabled;
  confirmed_ = false;
  paused_ = false;
  clearing_ = false;
  moved_ = false;
  stopping_ = false;
  reason_ = reason;
}

// Repeated until the controller says that it has taken it and stands, whatever it said before: that may be wrong.
void Session::askForDisable() {
  disabling_ = true;
  disable_sequence_ = static_cast<std::uint16_t>(link_.sequence() + 1);
  urgent_ = true;
}

void Session::receive(const std::uint8_t* data, std::size_t size, double now) {
  for (const LinkEvent& event : link_.receive(data, size, now)) {
    if (const auto* status = std::get_if<Status>(&event)) take(*status);
    if (const auto* lost = std::get_if<LinkLost>(&event)) drop(lost->reason);
  }
}

void Session::take(const Status& status) {
  if (disabling_ && compareSequence(status.echo, disable_sequence_) >= 0 && status.state != RobotState::kEnabled &&
      !status.moving) {
    disabling_ = urgent_ = false;
    if (reason_ == kUnconfirmed) reason_ = "disabled; the controller has confirmed it late";
    request_sequence_ = link_.sequence();
  }
  if (isFault(status)) {
    const std::string text = faultText(status);
    const bool known = reason_.rfind(text, 0) == 0;
    if (wish_ == Wish::kEnabled || (!clearing_ && !known)) drop(text);
    return;
  }
  if (clearing_) drop("fault cleared");
  if (reason_.rfind("fault: ", 0) == 0) reason_ = "the fault has gone by itself";
  if (wish_ != Wish::kEnabled) return;
  if (!status.homed) return drop("the arm has lost its homing: its joint positions mean nothing");
  if (status.state == RobotState::kEnabled && compareSequence(status.echo, request_sequence_) > 0) {
    if (!confirmed_) reason_.clear();
    confirmed_ = true;
  } else if (confirmed_ && status.state == RobotState::kDisabled) {
    drop("the controller has disabled itself");
    return;
  }
  if (stopping_ && compareSequence(status.echo, stop_sequence_) >= 0 && !status.moving) stopping_ = false;
}

void Session::watch(double now) {
  const bool was_up = link_.isUp();
  link_.watch(now);
  if (was_up && !link_.isUp()) drop(link_.reason());
  if (wish_ == Wish::kEnabled && !confirmed_ && now > deadline_) drop("the controller has not confirmed the enable");
  if (!disabling_ || !link_.isUp()) disable_deadline_ = now + config_.request_timeout;
  if (disabling_ && now > disable_deadline_) {
    reason_ = kUnconfirmed;
    stopped_ = true;
  }
  if (clearing_ && now > deadline_) {
    clearing_ = false;
    if (link_.status()) reason_ = faultText(*link_.status()) + "; it could not be cleared";
  }
}

Message Session::next(bool move, const std::array<double, kDrivenJoints>& speed) {
  const Status& status = *link_.status();
  if (clearing_) return ClearFault();
  if (disabling_) return Disable();
  if (wish_ == Wish::kDisabled) return status.state == RobotState::kEnabled ? Message(Disable()) : Message(Poll());
  if (!confirmed_) return Enable();
  if (move) return Velocity{speed, config_.time_to_live};
  return stopping_ ? Message(Stop()) : Message(Poll());
}

Bytes Session::transmit(const std::array<double, kDrivenJoints>& speed, double now) {
  watch(now);
  if (!link_.isUp()) return identify(now);
  if (!link_.status()) return link_.due(now) ? link_.send(Poll(), now) : Bytes();
  const bool sane = std::all_of(speed.begin(), speed.end(), [](double v) { return std::abs(v) <= kLargestNumber; });
  const bool zero = std::all_of(speed.begin(), speed.end(), [](double v) { return v == 0.0; });
  if (!isEnabled() || !sane || zero) {
    refusal_.clear();
    return request(false, speed, now);
  }
  try {
    Bytes bytes = request(true, speed, now);
    if (!bytes.empty()) refusal_.clear();
    return bytes;
  } catch (const std::invalid_argument& error) {
    refusal_ = std::string("the wire format cannot carry it: ") + error.what();
    return request(false, speed, now);
  }
}

// An Identify disables the controller: it is a Disable, too. Their numbers go on while nobody answers, for hours
// perhaps, until that of the Disable looks as if it were still to come.
Bytes Session::identify(double now) {
  Bytes bytes = link_.identify(now);
  if (!bytes.empty()) disable_sequence_ = link_.sequence();
  return bytes;
}

Bytes Session::request(bool move, const std::array<double, kDrivenJoints>& speed, double now) {
  if (moved_ && !move) {
    stopping_ = true;
    stop_sequence_ = static_cast<std::uint16_t>(link_.sequence() + 1);
    urgent_ = true;
  }
  if (!urgent_ && !link_.due(now)) {
    moved_ = move;
    return {};
  }
  Bytes bytes = link_.send(next(move, speed), now);
  moved_ = move;
  urgent_ = false;
  return bytes;
}

bool Session::isUnconfirmed() const {
  return reason_ == kUnconfirmed;
}

bool Session::isEnabled() const {
  return link_.isUp() && link_.status() && wish_ == Wish::kEnabled && confirmed_ && !paused_;
}

OperatingState Session::state() const {
  OperatingState state;
  state.reason = reason_;
  if (!link_.isUp() || !link_.status()) {
    if (!link_.isUp()) state.reason = "not connected: " + link_.reason();
    return state;
  }
  const Status& status = *link_.status();
  state.is_homed = status.homed;
  state.is_busy = status.moving || clearing_ || disabling_ || (wish_ == Wish::kEnabled && !confirmed_) ||
                  (wish_ == Wish::kDisabled && status.state == RobotState::kEnabled);
  if (isFault(status)) {
    state.mode = OperatingMode::kFault;
  } else if (wish_ == Wish::kEnabled && confirmed_) {
    state.mode = paused_ ? OperatingMode::kPaused : OperatingMode::kEnabled;
    if (!paused_ && state.reason.empty()) state.reason = refusal_;
  }
  return state;
}

}  // namespace laparoscope_servo::aesop
