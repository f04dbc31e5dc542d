// The states of a session and all transitions between them. Only a requested enable that the controller has confirmed
// leads to ENABLED; every end of it makes the controller disable.
//
// A state stands for the host's request and the controller's confirmation. A pending Disable is not a state of its own;
// see Session.
#pragma once

#include <string>
#include <vector>

namespace laparoscope_servo::aesop {

enum class SessionState : unsigned {
  kDisabled,
  kEnabling,  // enable was requested, the controller has not confirmed it
  kEnabled,
  kPaused,    // enabled, but no velocity is sent
  kClearing,  // clear_fault was requested, the fault has not gone
};

constexpr SessionState kSessionStates[] = {SessionState::kDisabled, SessionState::kEnabling, SessionState::kEnabled,
                                           SessionState::kPaused, SessionState::kClearing};

enum class SessionEvent : unsigned {
  // Requests that were accepted.
  kEnable,
  kDisable,
  kStop,  // disable by another cause than a service
  kClearFault,
  kPause,
  kResume,
  kGiveUp,  // an error of the arm
  // Reports of the controller, and reports that are overdue.
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

// What ended the last ENABLED: kStopped for another cause than a request, or for a disable that is not confirmed.
enum class SessionEnd { kAsBefore, kRequested, kStopped };

struct SessionTransition {
  unsigned from;  // a set of states, see contains()
  SessionEvent event;
  SessionState to;
  bool disables;  // a Disable is sent at once, and until the controller confirms it
  SessionEnd end;

  constexpr bool contains(SessionState state) const { return (from >> static_cast<unsigned>(state) & 1U) != 0; }
};

// All transitions, at most one for a state and an event. Without one, the event has no effect.
const std::vector<SessionTransition>& sessionTransitions();

// The transition of the table, or null.
const SessionTransition* sessionTransition(SessionState state, SessionEvent event);

// Enabled, or being enabled.
constexpr bool isOn(SessionState state) {
  return state == SessionState::kEnabling || state == SessionState::kEnabled || state == SessionState::kPaused;
}

}  // namespace laparoscope_servo::aesop
