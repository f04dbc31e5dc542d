#include "laparoscope_servo/aesop/session.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace laparoscope_servo::aesop {

namespace {

using State = SessionState;
using Event = SessionEvent;
using Kind = SessionReason::Kind;

bool isFault(const Status& status) {
  return status.state == RobotState::kFault || status.faults != 0;
}

SessionReason given(const std::string& words) {
  return {Kind::kGiven, 0, words};
}

}  // namespace

void Session::on(Event event, const std::optional<SessionReason>& reason) {
  const SessionTransition* transition = sessionTransition(state_, event);
  if (transition == nullptr) return;
  state_ = transition->to;
  if (reason) reason_ = *reason;
  if (transition->end != SessionEnd::kAsBefore) end_ = transition->end;
  if (transition->disables) askForDisable();
  if (state_ == State::kDisabled) motion_ = Motion::kStanding;
}

void Session::askForDisable() {
  if (disable_ == Disabling::kConfirmed) disable_ = Disabling::kAwaited;
  disable_sequence_ = static_cast<std::uint16_t>(link_.sequence() + 1);
  urgent_ = true;
}

std::string Session::enable(double now) {
  if (!link_.isUp()) return "not connected: " + link_.reason();
  if (!link_.status()) return "not connected: the controller has not sent its status yet";
  const Status& status = *link_.status();
  if (isFault(status)) return text({Kind::kFault, status.faults}) + "; clear_fault comes first";
  if (!status.homed) return "the arm is not homed: its joint positions mean nothing";
  if (isOn(state_)) return "";
  // The controller must be DISABLED first, so that no earlier motion can continue.
  if (status.state != RobotState::kDisabled) return "still disabling; try again";
  on(Event::kEnable, SessionReason{Kind::kEnableAskedFor});
  urgent_ = true;
  request_sequence_ = link_.sequence();
  deadline_ = now + config_.request_timeout;
  return "";
}

std::string Session::disable(double now, const std::string& reason) {
  return end(Event::kDisable, now, reason);
}

std::string Session::stop(double now, const std::string& reason) {
  return end(Event::kStop, now, reason);
}

std::string Session::end(Event event, double now, const std::string& reason) {
  on(event, given(reason));
  disable_ = Disabling::kAwaited;
  disable_deadline_ = now + config_.request_timeout;
  return link_.isUp() ? "" : "not connected: " + link_.reason();
}

std::string Session::clearFault(double now) {
  if (!link_.isUp() || !link_.status()) return "not connected: " + link_.reason();
  if (!isFault(*link_.status())) return "there is no fault";
  on(Event::kClearFault);
  urgent_ = true;
  deadline_ = now + config_.request_timeout;
  return "";
}

std::string Session::pause(const std::string& reason) {
  if (state_ == State::kPaused) return "";
  if (state_ != State::kEnabled) return "only an enabled arm can be paused";
  on(Event::kPause, given(reason));
  urgent_ = true;
  return "";
}

std::string Session::resume() {
  if (state_ != State::kPaused) return "the arm is not paused";
  on(Event::kResume, SessionReason());
  return "";
}

void Session::giveUp(const std::string& reason) {
  on(Event::kGiveUp, given(reason));
}

void Session::opened(double now) {
  const bool was_up = link_.isUp();
  link_.opened(now);
  if (was_up) on(Event::kLinkLost, given(link_.reason()));
}

void Session::closed(const std::string& reason) {
  link_.closed(reason);
  on(Event::kLinkLost, given(reason));
}

void Session::receive(const std::uint8_t* data, std::size_t size, double now) {
  for (const LinkEvent& event : link_.receive(data, size, now)) {
    if (const auto* status = std::get_if<Status>(&event)) take(*status);
    if (const auto* lost = std::get_if<LinkLost>(&event)) on(Event::kLinkLost, given(lost->reason));
  }
}

bool Session::confirmsDisable(const Status& status) const {
  return disable_ != Disabling::kConfirmed && compareSequence(status.echo, disable_sequence_) >= 0 &&
         status.state != RobotState::kEnabled && !status.moving;
}

void Session::take(const Status& status) {
  if (confirmsDisable(status)) {
    if (isUnconfirmed()) on(Event::kDisableConfirmed, SessionReason{Kind::kDisableConfirmedLate});
    disable_ = Disabling::kConfirmed;
    urgent_ = false;
    request_sequence_ = link_.sequence();
  }
  takeFault(status);
  if (!status.homed) on(Event::kNotHomed, SessionReason{Kind::kHomingLost});
  if (status.state == RobotState::kDisabled) on(Event::kDisabledItself, SessionReason{Kind::kDisabledItself});
  // Not while a Disable awaits its confirmation, since no Enable has been sent then.
  if (status.state == RobotState::kEnabled && disable_ == Disabling::kConfirmed &&
      compareSequence(status.echo, request_sequence_) > 0) {
    on(Event::kEnableConfirmed, SessionReason());
  }
  if (motion_ == Motion::kStopping && compareSequence(status.echo, stop_sequence_) >= 0 && !status.moving) {
    motion_ = Motion::kStanding;
  }
}

void Session::takeFault(const Status& status) {
  if (isFault(status)) {
    // An already reported fault keeps its reason text.
    if (isOn(state_) || !reason_.isFault() || reason_.faults != status.faults) {
      on(Event::kFault, SessionReason{Kind::kFault, status.faults});
    }
  } else if (state_ == State::kClearing) {
    on(Event::kNoFault, SessionReason{Kind::kFaultCleared});
  } else if (reason_.isFault()) {
    on(Event::kNoFault, SessionReason{Kind::kFaultGone});
  }
}

void Session::watch(double now) {
  const bool was_up = link_.isUp();
  link_.watch(now);
  if (was_up && !link_.isUp()) on(Event::kLinkLost, given(link_.reason()));
  if (now > deadline_) {
    on(Event::kEnableOverdue, SessionReason{Kind::kEnableNotConfirmed});
    if (link_.status()) on(Event::kClearOverdue, SessionReason{Kind::kFaultNotCleared, link_.status()->faults});
  }
  // No timeout of the Disable runs while the link is down.
  if (!link_.isUp() && isUnconfirmed()) disable_ = Disabling::kAwaited;
  if (!link_.isUp() || disable_ == Disabling::kConfirmed) disable_deadline_ = now + config_.request_timeout;
  if (now > disable_deadline_) {
    disable_ = Disabling::kOverdue;
    on(Event::kDisableOverdue);
  }
}

Message Session::next(bool move, const std::array<double, kDrivenJoints>& speed) {
  if (state_ == State::kClearing) return ClearFault();
  if (disable_ != Disabling::kConfirmed) return Disable();
  switch (state_) {
    case State::kDisabled:
      return link_.status()->state == RobotState::kEnabled ? Message(Disable()) : Message(Poll());
    case State::kEnabling:
      return Enable();
    default:
      break;
  }
  if (move) return Velocity{speed, config_.time_to_live};
  return motion_ == Motion::kStopping ? Message(Stop()) : Message(Poll());
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

// An Identify disables the controller, so it counts as the Disable that awaits its confirmation. Sequence numbers wrap
// at 65536; without this, the number of an old Disable would compare as newer after a long time without an answer.
Bytes Session::identify(double now) {
  Bytes bytes = link_.identify(now);
  if (!bytes.empty()) disable_sequence_ = link_.sequence();
  return bytes;
}

Bytes Session::request(bool move, const std::array<double, kDrivenJoints>& speed, double now) {
  if (motion_ == Motion::kMoving && !move) {
    motion_ = Motion::kStopping;
    stop_sequence_ = static_cast<std::uint16_t>(link_.sequence() + 1);
    urgent_ = true;
  }
  Bytes bytes;
  if (urgent_ || link_.due(now)) {
    bytes = link_.send(next(move, speed), now);
    urgent_ = false;
  }
  if (move) motion_ = Motion::kMoving;
  return bytes;
}

OperatingState Session::state() const {
  OperatingState state;
  state.reason = isUnconfirmed() ? "the controller does not confirm the disable" : text(reason_);
  if (!link_.isUp() || !link_.status()) {
    if (!link_.isUp()) state.reason = "not connected: " + link_.reason();
    return state;
  }
  const Status& status = *link_.status();
  state.is_homed = status.homed;
  state.is_busy = status.moving || disable_ != Disabling::kConfirmed || state_ == State::kClearing ||
                  state_ == State::kEnabling || (state_ == State::kDisabled && status.state == RobotState::kEnabled);
  if (isFault(status)) {
    state.mode = OperatingMode::kFault;
  } else if (state_ == State::kEnabled) {
    state.mode = OperatingMode::kEnabled;
    if (state.reason.empty()) state.reason = refusal_;
  } else if (state_ == State::kPaused) {
    state.mode = OperatingMode::kPaused;
  }
  return state;
}

}  // namespace laparoscope_servo::aesop
