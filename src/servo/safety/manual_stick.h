// Checks whether the scope may follow the commands of a stick, a slider or a pad.
//
// A stick that is deflected when driving begins, or that returns after silence, has no effect until it was seen at
// rest. Close to zero it counts as released, and then nothing moves: few sticks return to zero exactly. A pad out of
// radio range repeats its axes for ever: values other than zero that do not change in the last digit for too long are
// ignored until they change.
#pragma once

#include <string>

#include "laparoscope_servo/servo/manual_input.h"
#include "laparoscope_servo/servo/safety_config.h"

namespace laparoscope_servo::servo {

class ManualStick {
 public:
  // `full`: the velocity of which SafetyConfig::manual_neutral is a share.
  ManualStick(const SafetyConfig& config, const scope::Velocity& full) : config_(config), full_(full) {}

  // The stick must be seen at rest again.
  void restart() { seen_at_rest_ = false; }
  // Call in every step, at `time` [s]. `drives`: the stick moves the scope. Returns why the scope must not follow it,
  // in a text that does not change while this holds; empty if it may.
  std::string update(const ManualInput& input, bool drives, double time);
  // The velocity without the components in which the stick counts as released.
  scope::Velocity deflection(const scope::Velocity& velocity) const;

 private:
  std::string unusable(const ManualInput& input, double time) const;

  SafetyConfig config_;
  scope::Velocity full_;
  scope::Velocity last_;
  double since_ = 0.0;  // s, when it last changed
  bool seen_at_rest_ = false;
};

}  // namespace laparoscope_servo::servo
