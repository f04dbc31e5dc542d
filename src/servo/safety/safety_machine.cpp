#include "servo/safety/safety_machine.h"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace laparoscope_servo::servo {

namespace {

using State = SafetyState;
using Condition = SafetyCondition;

constexpr unsigned only(State state) {
  return 1U << static_cast<unsigned>(state);
}
constexpr unsigned kIdle = only(State::kIdle);
constexpr unsigned kArmed = only(State::kArmed);
constexpr unsigned kServo = only(State::kServo);
constexpr unsigned kHold = only(State::kHold);
constexpr unsigned kLost = only(State::kLost);
constexpr unsigned kFault = only(State::kFault);
constexpr unsigned kEngaged = kArmed | kServo | kHold;

// False for a NaN age.
bool isFresh(double age, double limit) {
  return age >= 0.0 && age <= limit;
}

// 0 at and below `none`, 1 at and above `all`, in a straight line between them.
double share(double value, double none, double all) {
  return value >= all ? 1.0 : std::clamp((value - none) / (all - none), 0.0, 1.0);
}

template <typename... Parts>
std::string text(const Parts&... parts) {
  std::ostringstream stream;
  (stream << ... << parts);
  return stream.str();
}

bool isOfTracker(Condition condition) {
  return condition == Condition::kTrackerUnusable || condition == Condition::kTrackerSilent ||
         condition == Condition::kImageOld || condition == Condition::kTrackerInvalid ||
         condition == Condition::kOccluded;
}

std::string when(bool holds, const std::string& reason) {
  return holds ? reason : std::string();
}

}  // namespace

const char* name(SafetyState state) {
  switch (state) {
    case SafetyState::kIdle:
      return "IDLE";
    case SafetyState::kArmed:
      return "ARMED";
    case SafetyState::kServo:
      return "SERVO";
    case SafetyState::kHold:
      return "HOLD";
    case SafetyState::kLost:
      return "LOST";
    case SafetyState::kFault:
      return "FAULT";
  }
  return "IDLE";
}

// All transitions. A self-transition only updates the reason.
const std::vector<SafetyTransition>& safetyTransitions() {
  static const char* const by_itself = "by itself";
  static const char* const resume = "resume the robot";
  static const char* const dead_man = "press the dead-man switch";
  static const char* const engage = "engage again";
  static const char* const disengage = "disengage, then engage again";
  static const char* const stop = "disengage";
  static const std::vector<SafetyTransition> table{
      {kEngaged, Condition::kClockJump, State::kFault, disengage},
      {kEngaged, Condition::kCommandNotFinite, State::kFault, disengage},
      {kEngaged, Condition::kResidualStop, State::kFault, disengage},
      {kEngaged, Condition::kShaftOffInsertionPoint, State::kFault, disengage},
      {kEngaged, Condition::kEffectWrong, State::kFault, disengage},
      {kEngaged | kLost | kFault, Condition::kDisengaged, State::kIdle, engage},
      {kEngaged, Condition::kEnded, State::kLost, engage},
      {kEngaged, Condition::kRobotStopped, State::kLost, engage},
      {kHold, Condition::kHeldTooLong, State::kLost, engage},
      {kHold, Condition::kRegionChanged, State::kLost, engage},
      {kEngaged, Condition::kRobotSilent, State::kHold, by_itself},
      {kEngaged, Condition::kRobotPaused, State::kHold, resume},
      {kEngaged, Condition::kPoseUnknown, State::kHold, by_itself},
      {kEngaged, Condition::kPoseOld, State::kHold, by_itself},
      {kEngaged, Condition::kDepthOutOfRange, State::kHold, by_itself},
      {kEngaged, Condition::kTrackerUnusable, State::kHold, by_itself},
      {kEngaged, Condition::kTrackerSilent, State::kHold, by_itself},
      {kEngaged, Condition::kImageOld, State::kHold, by_itself},
      {kEngaged, Condition::kTrackerInvalid, State::kHold, by_itself},
      {kEngaged, Condition::kOccluded, State::kHold, by_itself},
      {kEngaged, Condition::kEffectDoubted, State::kHold, by_itself},
      {kEngaged, Condition::kWandered, State::kHold, by_itself},
      {kIdle | kLost, Condition::kEngagedReleased, State::kArmed, dead_man},
      {kIdle | kLost, Condition::kEngaged, State::kServo, stop},
      {kEngaged, Condition::kDeadManReleased, State::kArmed, dead_man},
      {kArmed | kHold, Condition::kNothingMissing, State::kServo, stop},
  };
  return table;
}

SafetyOutput SafetyMachine::step(const SafetyFacts& facts) {
  for (const SafetyTransition& transition : safetyTransitions()) {
    if (!transition.contains(state_)) continue;
    const std::string why = cause(transition.condition, facts);
    if (why.empty()) continue;
    enter(transition, why, facts);
    break;
  }
  // The step time is checked only while engaged.
  has_time_ = isEngaged(state_);
  last_time_ = facts.time;
  return output(facts);
}

std::string SafetyMachine::refusal(const SafetyFacts& facts) const {
  if (state_ == State::kFault) return "in FAULT: " + reason_;
  // Every condition that ends motion also refuses to engage.
  for (const SafetyTransition& transition : safetyTransitions()) {
    if (!transition.contains(State::kServo)) continue;
    if (transition.to == State::kIdle || transition.to == State::kArmed) continue;
    const std::string why = cause(transition.condition, facts);
    if (!why.empty()) return why;
  }
  return "";
}

void SafetyMachine::enter(const SafetyTransition& transition, const std::string& cause, const SafetyFacts& facts) {
  if (transition.to == State::kHold && state_ != State::kHold) {
    hold_since_ = facts.time;
    held_region_ = facts.tracker.region;
    held_for_arm_ = false;
  }
  if (transition.to == State::kHold && !isOfTracker(transition.condition)) held_for_arm_ = true;
  if (!isEngaged(state_)) enables_ = facts.robot.enables;
  const bool needs_somebody = transition.to == State::kLost || transition.to == State::kFault;
  reason_ = needs_somebody ? cause + "; " + transition.way_on : cause;
  state_ = transition.to;
}

bool SafetyMachine::clockJumped(double time) const {
  if (!std::isfinite(time)) return true;
  return has_time_ && !(time >= last_time_ && time - last_time_ <= config_.max_clock_step);
}

std::string SafetyMachine::cause(SafetyCondition condition, const SafetyFacts& facts) const {
  const SafetyConfig& c = config_;
  const RobotFacts& robot = facts.robot;
  const PoseFacts& pose = facts.pose;
  const TrackerFacts& tracker = facts.tracker;
  const bool pose_usable = pose.problem.empty() && isFresh(pose.age, c.max_depth_age);
  const bool released =
      c.dead_man_required && !(facts.dead_man.pressed && isFresh(facts.dead_man.age, c.max_dead_man_age));
  switch (condition) {
    case Condition::kDisengaged:
      return when(facts.request == EngageRequest::kOff, facts.off_reason);
    case Condition::kEnded:
      return facts.ended;
    case Condition::kClockJump:
      if (!facts.clock_jump.empty()) return facts.clock_jump;
      return when(clockJumped(facts.time),
                  text("the steady clock jumped: back, or by more than ", c.max_clock_step, " s in one step"));
    case Condition::kCommandNotFinite:
      return when(!facts.command_finite, "the control law's velocity is not finite");
    case Condition::kResidualStop:
      return when(facts.residual == ResidualLevel::kStop, "the robot's poses do not agree with one insertion point");
    case Condition::kShaftOffInsertionPoint:
      return when(pose_usable && !(pose.lateral_offset >= 0.0 && pose.lateral_offset <= c.max_lateral_offset),
                  text("the shaft passes the insertion point at more than ", c.max_lateral_offset, " m"));
    case Condition::kEffectWrong:
      return when(facts.effect.effect == Effect::kWrong, facts.effect.words);
    case Condition::kEffectDoubted:
      return when(facts.effect.effect == Effect::kDoubted, facts.effect.words);
    case Condition::kWandered:
      return facts.wandered;
    case Condition::kHeldTooLong:
      return when(facts.time - hold_since_ >= c.resume_time, text("held for ", c.resume_time, " s: ", reason_));
    case Condition::kRegionChanged:
      return when(held_for_arm_ && held_region_ && tracker.region && *tracker.region != *held_region_,
                  "another region was selected while the arm was waited for");
    case Condition::kRobotSilent:
      if (!c.robot_required) return "";
      if (!robot.problem.empty()) return robot.problem;
      return when(!isFresh(robot.age, c.max_robot_state_age),
                  text("the robot's operating state is older than ", c.max_robot_state_age, " s"));
    case Condition::kRobotStopped:
      if (!c.robot_required || !robot.problem.empty()) return "";
      if (!robot.enabled && !robot.paused) return "the robot is not enabled";
      return when(isEngaged(state_) && robot.enables != enables_, "the robot was stopped, and enabled again");
    case Condition::kRobotPaused:
      return when(c.robot_required && robot.paused, "the robot is paused");
    case Condition::kPoseUnknown:
      return pose.problem;
    case Condition::kPoseOld:
      return when(!isFresh(pose.age, c.max_depth_age), text("depth d2 is older than ", c.max_depth_age, " s"));
    case Condition::kDepthOutOfRange:
      return when(!(pose.d2 - pose.d2_doubt >= c.min_depth && pose.d2 + pose.d2_doubt <= c.max_depth),
                  text("depth d2 is not between ", c.min_depth, " and ", c.max_depth, " m"));
    case Condition::kTrackerUnusable:
      return tracker.problem;
    case Condition::kTrackerSilent:
      return when(!isFresh(tracker.age, c.max_task_error_age),
                  text("the tracker is silent: its last task error is older than ", c.max_task_error_age, " s"));
    case Condition::kImageOld:
      return when(!isFresh(tracker.image_age, c.max_task_error_age),
                  text("the image behind the task error is older than ", c.max_task_error_age, " s"));
    case Condition::kTrackerInvalid:
      return when(!tracker.valid, "task error is not valid: the tracker does not track, or has no intrinsics");
    case Condition::kOccluded: {
      const bool going = state_ == State::kArmed || state_ == State::kServo;
      return when(!(tracker.visible_fraction >= (going ? c.hold_below : c.release_hold_above)),
                  text("too much of the region is occluded: visible fraction below ", c.hold_below, ", goes on from ",
                       c.release_hold_above));
    }
    case Condition::kEngagedReleased:
      return released && !cause(Condition::kEngaged, facts).empty() ? cause(Condition::kDeadManReleased, facts) : "";
    case Condition::kEngaged:
      return when(facts.request == EngageRequest::kOn && refusal(facts).empty(), "engaged, nothing is missing");
    case Condition::kDeadManReleased:
      if (released && !facts.dead_man.problem.empty()) return facts.dead_man.problem;
      return when(released, text("the dead-man switch is not pressed, or silent for ", c.max_dead_man_age, " s"));
    case Condition::kNothingMissing:
      return "engaged, nothing is missing";
  }
  return "";
}

SafetyOutput SafetyMachine::output(const SafetyFacts& facts) const {
  SafetyOutput output;
  output.state = state_;
  output.reason = reason_;
  if (state_ != State::kServo) return output;
  output.reset_history = false;
  const SafetyConfig& c = config_;
  const double visible = facts.tracker.visible_fraction;
  const double seen = share(visible, c.hold_below, c.slow_below);
  const double recent = share(-facts.tracker.image_age, -c.max_task_error_age, -c.slow_age * c.max_task_error_age);
  const double punctual = facts.tracker.punctual;
  output.speed_scale = std::min({seen, recent, punctual});
  const bool sees_enough = visible >= c.min_visible_for_insertion;
  const bool knows_where = facts.tracker.corner_error <= c.max_corner_error_for_insertion;
  output.insertion_allowed = sees_enough && knows_where;
  const auto add = [&output](const std::string& caution) {
    output.caution += (output.caution.empty() ? "" : "; ") + caution;
  };
  if (seen < 1.0) add(text("slow: visible fraction below ", c.slow_below));
  // The age goes up and down with each image: said is only what halves the speed.
  if (recent < 0.5) add(text("slow: image older than ", 0.5 * (1.0 + c.slow_age) * c.max_task_error_age, " s"));
  // Of an image that is dropped now and then nothing is said.
  if (!(punctual > 0.0)) add("stands: no image came when the next one was due");
  if (!sees_enough) add(text("not deeper: visible fraction below ", c.min_visible_for_insertion));
  if (!knows_where) add(text("not deeper: corner error above ", c.max_corner_error_for_insertion, " px"));
  if (facts.residual == ResidualLevel::kWarning) add("the residual of the insertion point grows");
  return output;
}

}  // namespace laparoscope_servo::servo
