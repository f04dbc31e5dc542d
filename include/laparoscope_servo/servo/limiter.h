// Limits on velocity and acceleration that keep the direction of the motion.
//
// All four components are scaled together, so that the ROI takes the same path in the image, only slower. A velocity
// beyond its limit scales the whole command; a change beyond the acceleration's limit scales the whole change, so that
// the command goes straight from the last one to the wanted one. Both limits hold for each component, whatever is asked
// for.
#pragma once

#include "laparoscope_servo/servo/scope_velocity.h"

namespace laparoscope_servo::servo {

struct Limits {
  ScopeVelocity velocity{0.1, 0.1, 0.1, 0.02};     // rad/s, rad/s, rad/s, m/s
  ScopeVelocity acceleration{0.5, 0.5, 0.5, 0.1};  // rad/s², rad/s², rad/s², m/s²
};

class Limiter {
 public:
  explicit Limiter(const Limits& limits) : limits_(limits) {}

  // The command for a time `dt` [s] >= 0 after the last one. `wanted` must be finite.
  ScopeVelocity apply(const ScopeVelocity& wanted, double dt);

  // The last command is zero: a safety stop is not slowed down by the limit on acceleration.
  void reset() { last_ = ScopeVelocity(); }

 private:
  Limits limits_;
  ScopeVelocity last_;
};

}  // namespace laparoscope_servo::servo
