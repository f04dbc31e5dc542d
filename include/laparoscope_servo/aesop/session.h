// The state of the robot as known to the host, and the next request to send. Only enable() leads to ENABLED: a lost
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

  // Requests. Each returns why it is refused, or an empty string if it is under way; state() has its result.
  std::string enable(double now);
  std::string disable(double now, const std::string& reason = "disabled on request");
  // Disables for another cause than a service call: counts as a stop, see stopped().
  std::string stop(double now, const std::string& reason);
  std::string clearFault(double now);
  std::string pause(const std::string& reason = "paused on request");
  std::string resume();
  // Disables because of an error; the state holds its reason until the next enable.
  void giveUp(const std::string& reason);

  void opened(double now);
  void closed(const std::string& reason);
  void receive(const std::uint8_t* data, std::size_t size, double now);
  // The bytes to send now, often none. `speed`: wanted velocities of the driven joints at this moment; sent only while
  // ENABLED. All zero, a non-finite value or one that the wire format cannot carry is a stop, which is sent at once and
  // until the controller confirms that the arm is at rest.
  Bytes transmit(const std::array<double, kDrivenJoints>& speed, double now);

  OperatingState state() const;
  bool isEnabled() const { return state_ == SessionState::kEnabled; }  // confirmed and not paused
  // The last request was a velocity.
  bool isMoving() const { return motion_ == Motion::kMoving; }
  // The last ENABLED was ended by another cause than a request, or the disable is not confirmed.
  bool stopped() const { return end_ == SessionEnd::kStopped; }
  // The controller has not confirmed a disable in time: the arm may still move.
  bool isUnconfirmed() const { return disable_ == Disabling::kOverdue; }
  const Link& link() const { return link_; }
  void setSequence(std::uint16_t sequence) { link_.setSequence(sequence); }

 private:
  // State of the Disable, which is repeated until the controller reports that it took it and is at rest. Earlier
  // reports of rest do not count.
  enum class Disabling { kConfirmed, kAwaited, kOverdue };
  enum class Motion { kStanding, kMoving, kStopping };  // kStopping: until the controller reports rest

  // Takes the table's transition for this event, if there is one; `reason` is then that of the new state.
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
  std::uint16_t stop_sequence_ = 0;     // sequence number of the first stop after a velocity
  std::uint16_t disable_sequence_ = 0;  // sequence number of the first disable
  std::uint16_t request_sequence_ = 0;  // sequence number of the last request before the enable
  double deadline_ = 0.0;               // s, for the enable or the clear_fault under way
  double disable_deadline_ = 0.0;       // s
  std::string refusal_;                 // why the last speed was not sent
};

}  // namespace laparoscope_servo::aesop
