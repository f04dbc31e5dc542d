// The state machine of the safety states: whether the scope may move, how fast, and the reason.
//
// One table holds all transitions, see safetyTransitions(). Pure: no clock, the same facts give the same states.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "laparoscope_servo/servo/residual_level.h"
#include "laparoscope_servo/servo/safety_config.h"
#include "laparoscope_servo/servo/safety_facts.h"
#include "servo/safety/effect.h"

namespace laparoscope_servo::servo {

enum class EngageRequest { kNone, kOn, kOff };

struct PoseFacts {
  std::string problem = "depth d2 is unknown";  // why it cannot be used; empty: it can
  double age = std::numeric_limits<double>::infinity();
  double d2 = 0.0;              // m, along the shaft from the insertion point to the camera
  double lateral_offset = 0.0;  // m, distance of the insertion point from the shaft
  double d2_doubt = 0.0;        // m, uncertainty of d2
};

struct TrackerFacts {
  std::string problem = "no task error was received";             // why it cannot be used; empty: it can
  double age = std::numeric_limits<double>::infinity();           // s, since the message was received
  double image_age = std::numeric_limits<double>::infinity();     // s, since its image was taken
  bool valid = false;                                             // `valid` field of the message
  std::optional<double> region;                                   // identifies the region of interest
  double visible_fraction = 0.0;                                  // 0 to 1, visible share of the region of interest
  double corner_error = std::numeric_limits<double>::infinity();  // px, expected error of the worst corner
  double punctual = 1.0;  // 0 to 1, share of the speed for the image's age by what is usual, see usual_age.h
};

struct EffectFacts {
  Effect effect = Effect::kAsCommanded;
  std::string words;  // description of the fault, if `effect` is not kAsCommanded
};

// Input of one step.
struct SafetyFacts {
  double time = 0.0;  // s, on a clock that never jumps
  EngageRequest request = EngageRequest::kNone;
  std::string off_reason = "not engaged";  // reason of the state IDLE after kOff
  std::string clock_jump;                  // description of a clock jump since the last step; empty: none
  std::string ended;                       // event that has ended the engagement since the last step; empty: none
  bool command_finite = true;              // the control law's last velocity is finite
  ResidualLevel residual = ResidualLevel::kOk;
  RobotFacts robot;
  PoseFacts pose;
  TrackerFacts tracker;
  EffectFacts effect;
  std::string wandered;  // which way the view has wandered too far; empty: it has not
  DeadManFacts dead_man;
};

struct SafetyOutput {
  SafetyState state = SafetyState::kIdle;
  std::string reason = "not engaged";  // never empty; does not change while its cause lasts
  double speed_scale = 0.0;            // 0 to 1, for the whole velocity; 0 unless in SERVO
  // false: not deeper. Outwards is always allowed: it leads away from the tissue, along the path on which the scope
  // came, down to min_depth
  bool insertion_allowed = false;
  bool reset_history = true;  // the command is zero at once: filters and limits start from rest
  std::string caution;        // in SERVO: what slows the scope or keeps it from going deeper; empty: nothing
};

// Conditions of the transitions.
enum class SafetyCondition {
  kDisengaged,
  kEnded,
  kClockJump,
  kCommandNotFinite,
  kResidualStop,
  kShaftOffInsertionPoint,
  kEffectWrong,
  kHeldTooLong,
  kRegionChanged,
  kRobotSilent,
  kRobotStopped,
  kRobotPaused,
  kPoseUnknown,
  kPoseOld,
  kDepthOutOfRange,
  kTrackerUnusable,
  kTrackerSilent,
  kImageOld,
  kTrackerInvalid,
  kOccluded,
  kEffectDoubted,
  kWandered,
  kEngagedReleased,
  kEngaged,
  kDeadManReleased,
  kNothingMissing,
};

struct SafetyTransition {
  unsigned from;  // a set of states, see contains()
  SafetyCondition condition;
  SafetyState to;
  const char* way_on;  // what ends the new state, for display

  constexpr bool contains(SafetyState state) const { return (from >> static_cast<unsigned>(state) & 1U) != 0; }
};

// All transitions, the most severe first. In each step the first one that leaves the present state and whose condition
// holds is taken; where there is none, the state stays.
const std::vector<SafetyTransition>& safetyTransitions();

class SafetyMachine {
 public:
  // `config` must be valid, see validate(const ControllerConfig&).
  explicit SafetyMachine(const SafetyConfig& config) : config_(config) {}

  SafetyOutput step(const SafetyFacts& facts);

  // The reason why engaging would be refused now; empty if it would not. The dead-man switch is no reason.
  std::string refusal(const SafetyFacts& facts) const;

  SafetyState state() const { return state_; }

 private:
  bool clockJumped(double time) const;
  // Text of the reason if the condition holds, else empty.
  std::string cause(SafetyCondition condition, const SafetyFacts& facts) const;
  void enter(const SafetyTransition& transition, const std::string& cause, const SafetyFacts& facts);
  SafetyOutput output(const SafetyFacts& facts) const;

  SafetyConfig config_;
  SafetyState state_ = SafetyState::kIdle;
  std::string reason_ = "not engaged";
  bool has_time_ = false;
  double last_time_ = 0.0;   // s, of the last step while engaged
  double hold_since_ = 0.0;  // s
  std::optional<double> held_region_;
  std::uint32_t enables_ = 0;  // RobotFacts::enables at engaging
  // HOLD has another cause than the tracker, which is silent while another region is selected
  bool held_for_arm_ = false;
};

}  // namespace laparoscope_servo::servo
