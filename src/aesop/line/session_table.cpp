#include "laparoscope_servo/aesop/session_table.h"

namespace laparoscope_servo::aesop {

namespace {

using State = SessionState;
using Event = SessionEvent;
using End = SessionEnd;

constexpr unsigned only(State state) {
  return 1U << static_cast<unsigned>(state);
}
constexpr unsigned kDisabled = only(State::kDisabled);
constexpr unsigned kEnabling = only(State::kEnabling);
constexpr unsigned kEnabled = only(State::kEnabled);
constexpr unsigned kPaused = only(State::kPaused);
constexpr unsigned kClearing = only(State::kClearing);
constexpr unsigned kOn = kEnabling | kEnabled | kPaused;
constexpr unsigned kOff = kDisabled | kClearing;

}  // namespace

// All transitions. A self-transition only updates the reason.
const std::vector<SessionTransition>& sessionTransitions() {
  constexpr bool disables = true;
  constexpr bool sends_nothing = false;
  static const std::vector<SessionTransition> table{
      {kDisabled, Event::kEnable, State::kEnabling, sends_nothing, End::kRequested},
      {kEnabling, Event::kEnableConfirmed, State::kEnabled, sends_nothing, End::kAsBefore},
      {kEnabled, Event::kPause, State::kPaused, sends_nothing, End::kAsBefore},
      {kPaused, Event::kResume, State::kEnabled, sends_nothing, End::kAsBefore},

      {kOn | kOff, Event::kDisable, State::kDisabled, disables, End::kRequested},
      {kOn | kOff, Event::kStop, State::kDisabled, disables, End::kStopped},
      {kOn, Event::kGiveUp, State::kDisabled, disables, End::kStopped},
      {kOn, Event::kLinkLost, State::kDisabled, disables, End::kStopped},
      {kOn, Event::kFault, State::kDisabled, disables, End::kStopped},
      {kOn, Event::kNotHomed, State::kDisabled, disables, End::kStopped},
      {kEnabled | kPaused, Event::kDisabledItself, State::kDisabled, disables, End::kStopped},  // by its own report
      {kEnabling, Event::kEnableOverdue, State::kDisabled, disables, End::kStopped},

      {kDisabled, Event::kClearFault, State::kClearing, sends_nothing, End::kAsBefore},
      {kClearing, Event::kClearFault, State::kClearing, sends_nothing, End::kAsBefore},  // starts the timeout again
      {kClearing, Event::kNoFault, State::kDisabled, sends_nothing, End::kAsBefore},
      {kClearing, Event::kClearOverdue, State::kDisabled, sends_nothing, End::kAsBefore},

      {kOff, Event::kGiveUp, State::kDisabled, sends_nothing, End::kAsBefore},
      {kOff, Event::kLinkLost, State::kDisabled, sends_nothing, End::kAsBefore},
      {kDisabled, Event::kFault, State::kDisabled, sends_nothing, End::kAsBefore},
      {kDisabled, Event::kNoFault, State::kDisabled, sends_nothing, End::kAsBefore},
      {kDisabled, Event::kDisableConfirmed, State::kDisabled, sends_nothing, End::kAsBefore},
      {kEnabling, Event::kDisableConfirmed, State::kEnabling, sends_nothing, End::kAsBefore},
      {kClearing, Event::kDisableConfirmed, State::kClearing, sends_nothing, End::kAsBefore},
      {kDisabled, Event::kDisableOverdue, State::kDisabled, sends_nothing, End::kStopped},
      {kEnabling, Event::kDisableOverdue, State::kEnabling, sends_nothing, End::kStopped},
      {kClearing, Event::kDisableOverdue, State::kClearing, sends_nothing, End::kStopped},
  };
  return table;
}

const SessionTransition* sessionTransition(State state, Event event) {
  for (const SessionTransition& transition : sessionTransitions()) {
    if (transition.event == event && transition.contains(state)) return &transition;
  }
  return nullptr;
}

}  // namespace laparoscope_servo::aesop
