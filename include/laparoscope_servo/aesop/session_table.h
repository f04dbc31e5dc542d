// The states of a session and all transitions between them. Nothing leads to ENABLED but an enable that was asked for
// and that the controller has confirmed; whatever ends it asks the controller to disable.
//
// What the host wants and what the controller has confirmed of it is the state. That a Disable has not been confirmed
// yet is none: it goes on in each of them, see Session.
#pragma once

#include <string>
#include <vector>

namespace laparoscope_servo::aesop {

enum class SessionState : unsigned {
  kDisabled,
  kEnabling,  // enable is asked for, until the controller confirms it
  kEnabled,
  kPaused,    // enabled, but no velocity is sent
  kClearing,  // clear_fault is asked for, until the fault has gone
};

constexpr SessionState kSessionStates[] = {SessionState::kDisabled, SessionState::kEnabling, SessionState::kEnabled,
                                           SessionState::kPaused, SessionState::kClearing};

enum class SessionEvent : unsigned {
  // Requests, where nothing speaks against them.
  kEnable,
  kDisable,
  kStop,  // the same by something else than a service
  kClearFault,
  kPause,
  kResume,
  kGiveUp,  // something is wrong with the arm
  // What the controller says, or does not say in time.
  kLinkLost,
  kFault,
  kNoFault,
  kNotHomed,
  kEnableConfirmed,
  kDisabledItself,
  kDisableConfirmed,
  kEnableOverdue,
  kClearOverdue,
  kDisableOverdue,
};

constexpr unsigned kSessionEvents = static_cast<unsigned>(SessionEvent::kDisableOverdue) + 1;

// Whether something else than a request is what has ended the last ENABLED, or a disable is not confirmed.
enum class SessionEnd { kAsBefore, kRequested, kStopped };

struct SessionTransition {
  unsigned from;  // a set of states, see contains()
  SessionEvent event;
  SessionState to;
  bool disables;  // the controller is told to disable, at once and until it confirms it
  SessionEnd end;

  constexpr bool contains(SessionState state) const { return (from >> static_cast<unsigned>(state) & 1U) != 0; }
};

// All transitions, at most one for a state and an event. Where there is none, the event changes nothing.
const std::vector<SessionTransition>& sessionTransitions();

// The one of the table, or null.
const SessionTransition* sessionTransition(SessionState state, SessionEvent event);

// Enabled, or on the way there.
constexpr bool isOn(SessionState state) {
  return state == SessionState::kEnabling || state == SessionState::kEnabled || state == SessionState::kPaused;
}

}  // namespace laparoscope_servo::aesop
