// The state of the robot as the host sees it, and what to send next. Nothing leads to ENABLED but enable(): a lost
// link, a fault, a controller that disables itself or restarts all end in DISABLED or FAULT. session_table.h holds all
// transitions.
//
// Pure, as Link is: `now` is seconds of a steady clock.
#pragma once

#include <optional>
#include <string>

#include "laparoscope_servo/aesop/link.h"
#include "laparoscope_servo/aesop/operating_state.h"
#include "laparoscope_servo/aesop/session_reason.h"
#include "laparoscope_servo/aesop/session_table.h"

namespace laparoscope_servo::aesop {

class Session {
 public:
  Session(const SessionConfig& config, std::uint8_t driven) : config_(config), link_(config, driven) {}

  // Requests. Each returns why it cannot be, or an empty string when it is under way: state() tells how it ends.
  std::string enable(double now);
  std::string disable(double now, const std::string& reason = "disabled on request");
  // The same for who asks for it by something else than a service: it counts as a stop, see stopped().
  std::string stop(double now, const std::string& reason);
  std::string clearFault(double now);
  std::string pause(const std::string& reason = "paused on request");
  std::string resume();
  // Disables because something is wrong; until the next enable, the state tells what.
  void giveUp(const std::string& reason);

  void opened(double now);
  void closed(const std::string& reason);
  void receive(const std::uint8_t* data, std::size_t size, double now);
  // What to send now, often nothing. `speed`: of the driven joints, as wanted at this moment; it reaches the wire only
  // while ENABLED. All zero, one that is not finite or that the wire cannot carry, is a stop, which is sent at once
  // and until the controller confirms that it stands.
  Bytes transmit(const std::array<double, kDrivenJoints>& speed, double now);

  OperatingState state() const;
  bool isEnabled() const { return state_ == SessionState::kEnabled; }  // and confirmed, and not paused
  // The last request was a velocity.
  bool isMoving() const { return motion_ == Motion::kMoving; }
  // Something else than a request has ended the last ENABLED, or the disable is not confirmed.
  bool stopped() const { return end_ == SessionEnd::kStopped; }
  // The controller has not confirmed a disable in time: the arm may still move.
  bool isUnconfirmed() const { return disable_ == Disabling::kOverdue; }
  const Link& link() const { return link_; }
  void setSequence(std::uint16_t sequence) { link_.setSequence(sequence); }

 private:
  // Of the Disable, which is repeated until the controller says that it has taken it and stands, whatever it said
  // before: that may be wrong.
  enum class Disabling { kConfirmed, kAwaited, kOverdue };
  enum class Motion { kStanding, kMoving, kStopping };  // kStopping: until the controller says that it stands

  // What the table has for this event; `reason`: that of the state from then on, where the table has something.
  void on(SessionEvent event, const std::optional<SessionReason>& reason = std::nullopt);
  std::string end(SessionEvent event, double now, const std::string& reason);
  void askForDisable();
  void watch(double now);
  void take(const Status& status);
  void takeFault(const Status& status);
  bool confirmsDisable(const Status& status) const;
  Bytes identify(double now);
  Bytes request(bool move, const std::array<double, kDrivenJoints>& speed, double now);
  Message next(bool move, const std::array<double, kDrivenJoints>& speed);

  SessionConfig config_;
  Link link_;
  SessionState state_ = SessionState::kDisabled;
  SessionEnd end_ = SessionEnd::kRequested;
  SessionReason reason_{SessionReason::Kind::kNotEnabledYet};
  Disabling disable_ = Disabling::kConfirmed;
  Motion motion_ = Motion::kStanding;
  bool urgent_ = false;                 // send at once, not at the next slot
  std::uint16_t stop_sequence_ = 0;     // of the first stop after a velocity
  std::uint16_t disable_sequence_ = 0;  // of the first disable
  std::uint16_t request_sequence_ = 0;  // of the last request before the enable
  double deadline_ = 0.0;               // s, for the enable or the clear_fault under way
  double disable_deadline_ = 0.0;       // s
  std::string refusal_;                 // why the last speed did not reach the wire
};

}  // namespace laparoscope_servo::aesop
