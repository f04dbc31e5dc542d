// Which safety state follows: whether the scope may move, how fast, and why not.
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
  double lateral_offset = 0.0;  // m, of the insertion point from the shaft
  double d2_doubt = 0.0;        // m, by which d2 may be less or more
};

struct TrackerFacts {
  std::string problem = "no task error was received";             // why it cannot be used; empty: it can
  double age = std::numeric_limits<double>::infinity();           // since it came
  double image_age = std::numeric_limits<double>::infinity();     // since the image behind it was taken
  bool valid = false;                                             // the tracker's own word
  std::optional<double> region;                                   // another number is another region of interest
  double visible_fraction = 0.0;                                  // 0 to 1, of the region of interest
  double corner_error = std::numeric_limits<double>::infinity();  // px, expected of the worst corner
};

struct EffectFacts {
  Effect effect = Effect::kAsCommanded;
  std::string words;  // what was seen, where it is not as commanded
};

// What is known in one step.
struct SafetyFacts {
  double time = 0.0;  // s, on a clock that never jumps
  EngageRequest request = EngageRequest::kNone;
  std::string off_reason = "not engaged";  // of the state IDLE that kOff leads to
  std::string clock_jump;                  // what jumped since the last step, in words; empty: nothing did
  std::string ended;                       // what has ended the engagement since the last step; empty: nothing
  bool command_finite = true;              // the control law's last velocity
  ResidualLevel residual = ResidualLevel::kOk;
  RobotFacts robot;
  PoseFacts pose;
  TrackerFacts tracker;
  EffectFacts effect;
  DeadManFacts dead_man;
};

struct SafetyOutput {
  SafetyState state = SafetyState::kIdle;
  std::string reason = "not engaged";  // never empty; stays the same, letter by letter, while its cause does
  double speed_scale = 0.0;            // 0 to 1, for the whole velocity; 0 unless in SERVO
  bool insertion_allowed = false;  // false: not deeper. Outwards stays allowed: it is away from the tissue, along the
                                   // way that the scope came, and min_depth ends it
  bool reset_history = true;       // the command is zero at once: filters and limits start from rest
  std::string caution;             // in SERVO: what slows the scope or lets it go no deeper; empty: nothing
};

// What can lead from one state to another.
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
  kEngagedReleased,
  kEngaged,
  kDeadManReleased,
  kNothingMissing,
};

struct SafetyTransition {
  unsigned from;  // a set of states, see contains()
  SafetyCondition condition;
  SafetyState to;
  const char* way_on;  // who or what ends the state, in words

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

  // Why a request to engage would be refused now; empty when it would not. The dead-man switch refuses nothing.
  std::string refusal(const SafetyFacts& facts) const;

  SafetyState state() const { return state_; }

 private:
  bool clockJumped(double time) const;
  // The reason when the condition holds, empty when it does not.
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
  std::uint32_t enables_ = 0;  // of the robot, when engaged
  bool held_for_arm_ = false;  // not for the tracker alone, which says nothing while it learns another region
};

}  // namespace laparoscope_servo::servo
