// The states of the controller, and what it is told of the robot and of the dead-man switch.
//
//   IDLE   not engaged
//   ARMED  engaged and everything is there, but the dead-man switch is not pressed
//   SERVO  the only state in which the scope moves
//   HOLD   engaged, but something that motion relies on is missing for now; goes on by itself when it comes back within
//          `resume_time`, so that an instrument may cross the region
//   LOST   was missing for longer, or another region was selected while it was the arm that was waited for, or somebody
//          has stopped the robot: engaged no more, somebody has to look at the arm and engage again
//   FAULT  something that must not be: only disengaging clears it
//
// Whatever is not SERVO commands exactly zero, at once.
#pragma once

#include <cstdint>
#include <limits>
#include <string>

namespace laparoscope_servo::servo {

enum class SafetyState : unsigned { kIdle, kArmed, kServo, kHold, kLost, kFault };

constexpr SafetyState kSafetyStates[] = {SafetyState::kIdle, SafetyState::kArmed, SafetyState::kServo,
                                         SafetyState::kHold, SafetyState::kLost,  SafetyState::kFault};

// IDLE, ARMED and so on, as messages and files have it.
const char* name(SafetyState state);

// Engaged: the scope moves, or may begin to without anybody engaging it.
constexpr bool isEngaged(SafetyState state) {
  return state == SafetyState::kArmed || state == SafetyState::kServo || state == SafetyState::kHold;
}

// Facts as constructed: nothing is there. Ages are in s; one that is negative or NaN is too old.
struct RobotFacts {
  std::string problem = "no operating state of the robot was received";  // empty: there is one
  bool enabled = false;
  double age = std::numeric_limits<double>::infinity();
  bool paused = false;        // enabled, but paused: somebody resumes it. Neither of the two: it was stopped
  std::uint32_t enables = 0;  // how often it was enabled: another number, and it was stopped meanwhile
};

struct DeadManFacts {
  bool pressed = false;
  double age = std::numeric_limits<double>::infinity();
  std::string problem = {};  // why a switch that says "pressed" does not count; empty: it counts, or is not pressed
};

}  // namespace laparoscope_servo::servo
