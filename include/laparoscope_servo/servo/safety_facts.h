// The states of the controller, and its input from the robot and the dead-man switch.
//
//   IDLE   not engaged
//   ARMED  engaged and nothing is missing, but the dead-man switch is not pressed
//   SERVO  the only state in which the scope moves
//   HOLD   engaged, but an input is missing, late or out of range; returns to SERVO or ARMED by itself if it is back
//          within `resume_time`, so that an instrument may cross the region
//   LOST   no longer engaged: HOLD lasted for `resume_time`, the robot was stopped, another node or an operator ended
//          the engagement, or another region was selected during a HOLD for the arm. Left by engaging again
//   FAULT  no longer engaged: a clock jumped, a command was not finite, the robot's poses do not agree with the
//          insertion point, or the picture moves as with a fault. Left by disengaging only
//
// All states but SERVO command exactly zero, at once. The transitions and the rest of their input are in
// src/servo/safety/safety_machine.h.
#pragma once

#include <cstdint>
#include <limits>
#include <string>

namespace laparoscope_servo::servo {

enum class SafetyState : unsigned { kIdle, kArmed, kServo, kHold, kLost, kFault };

constexpr SafetyState kSafetyStates[] = {SafetyState::kIdle, SafetyState::kArmed, SafetyState::kServo,
                                         SafetyState::kHold, SafetyState::kLost,  SafetyState::kFault};

// IDLE, ARMED and so on, as in messages and files.
const char* name(SafetyState state);

// Engaged: the scope moves, or may start to move without another call of engage.
constexpr bool isEngaged(SafetyState state) {
  return state == SafetyState::kArmed || state == SafetyState::kServo || state == SafetyState::kHold;
}

// Default values mean: nothing was received. Ages are in s; a negative or NaN age counts as too old.
struct RobotFacts {
  // why there is no usable state; empty: there is one
  std::string problem = "no operating state of the robot was received";
  bool enabled = false;
  double age = std::numeric_limits<double>::infinity();
  bool paused = false;        // enabled, but paused until an operator resumes it. Neither enabled nor paused: stopped
  std::uint32_t enables = 0;  // number of times it was enabled; if it changes, the robot was stopped meanwhile
};

struct DeadManFacts {
  bool pressed = false;
  double age = std::numeric_limits<double>::infinity();
  std::string problem = {};  // why "pressed" does not count; empty: it counts, or the switch is not pressed
};

}  // namespace laparoscope_servo::servo
