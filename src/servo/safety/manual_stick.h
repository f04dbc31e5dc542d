// Whether the scope may be driven by what a stick, a slider or a pad says.
//
// A stick that is deflected when driving begins moves nothing before it was seen at rest, nor does one that comes back
// from silence. A pad that has gone out of reach repeats its axes for ever: what is not zero and stays the same to the
// last digit for too long is taken for that, until something changes.
#pragma once

#include <string>

#include "laparoscope_servo/servo/manual_input.h"
#include "laparoscope_servo/servo/safety_config.h"

namespace laparoscope_servo::servo {

class ManualStick {
 public:
  // `full`: the velocity of which SafetyConfig::manual_neutral is a share.
  ManualStick(const SafetyConfig& config, const scope::Velocity& full) : config_(config), full_(full) {}

  // It has to be seen at rest again.
  void restart() { seen_at_rest_ = false; }
  // In every step, at `time` [s]. `drives`: it is the stick that moves the scope. Returns why the scope must not follow
  // it, in words that stay the same while it is so; empty when it may.
  std::string update(const ManualInput& input, bool drives, double time);

 private:
  std::string unusable(const ManualInput& input, double time) const;
  bool isAtRest(const scope::Velocity& velocity) const;

  SafetyConfig config_;
  scope::Velocity full_;
  scope::Velocity last_;
  double since_ = 0.0;  // s, when it became what it is
  bool seen_at_rest_ = false;
};

}  // namespace laparoscope_servo::servo
