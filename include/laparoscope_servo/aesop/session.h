// The state of the robot as the host sees it, and what to send next. Nothing leads to ENABLED but enable(): a lost
// link, a fault, a controller that disables itself or restarts all end in DISABLED or FAULT.
//
// Pure, as Link is: `now` is seconds of a steady clock.
#pragma once

#include <string>

#include "laparoscope_servo/aesop/link.h"

namespace laparoscope_servo::aesop {

// Names of the Collaborative Robotics Toolkit.
enum class OperatingMode { kDisabled, kEnabled, kPaused, kFault };

const char* name(OperatingMode mode);

struct OperatingState {
  OperatingMode mode = OperatingMode::kDisabled;
  bool is_homed = false;
  bool is_busy = false;  // the arm moves, or a request waits for its confirmation
  std::string reason;

  bool operator==(const OperatingState& other) const {
    return mode == other.mode && is_homed == other.is_homed && is_busy == other.is_busy && reason == other.reason;
  }
};

// As in a recording: a byte for the mode, one for the flags, the reason. The way back throws std::invalid_argument.
Bytes payloadOf(const OperatingState& state);
OperatingState stateOf(const Bytes& payload);

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
  void giveUp(const std::string& reason) { drop(reason); }

  void opened(double now) { link_.opened(now); }
  void closed(const std::string& reason);
  void receive(const std::uint8_t* data, std::size_t size, double now);
  // What to send now, often nothing. `speed`: of the driven joints, as wanted at this moment; it reaches the wire only
  // while ENABLED. All zero, one that is not finite or that the wire cannot carry, is a stop, which is sent at once
  // and until the controller confirms that it stands.
  Bytes transmit(const std::array<double, kDrivenJoints>& speed, double now);

  OperatingState state() const;
  bool isEnabled() const;  // ENABLED and confirmed, and not paused
  // The last request was a velocity.
  bool isMoving() const { return moved_; }
  // Something else than a request has ended the last ENABLED, or the disable is not confirmed.
  bool stopped() const { return stopped_; }
  // The controller has not confirmed a disable in time: the arm may still move.
  bool isUnconfirmed() const;
  const Link& link() const { return link_; }
  void setSequence(std::uint16_t sequence) { link_.setSequence(sequence); }

 private:
  enum class Wish { kDisabled, kEnabled };

  void drop(const std::string& reason);
  void askForDisable();
  void watch(double now);
  void take(const Status& status);
  Bytes identify(double now);
  Bytes request(bool move, const std::array<double, kDrivenJoints>& speed, double now);
  Message next(bool move, const std::array<double, kDrivenJoints>& speed);

  SessionConfig config_;
  Link link_;
  Wish wish_ = Wish::kDisabled;
  bool confirmed_ = false;  // the controller has confirmed the enable
  bool paused_ = false;
  bool clearing_ = false;
  bool urgent_ = false;                 // send at once, not at the next slot
  bool moved_ = false;                  // the last request was a velocity
  bool stopping_ = false;               // stop not yet confirmed
  bool disabling_ = false;              // disable not yet confirmed
  bool stopped_ = false;                // see stopped()
  std::uint16_t stop_sequence_ = 0;     // of the first stop after a velocity
  std::uint16_t disable_sequence_ = 0;  // of the first disable
  std::uint16_t request_sequence_ = 0;  // of the last request before the enable
  double deadline_ = 0.0;               // s, for the confirmation under way
  double disable_deadline_ = 0.0;       // s
  std::string reason_ = "not enabled yet";
  std::string refusal_;  // why the last speed did not reach the wire
};

}  // namespace laparoscope_servo::aesop
