// Limits on velocity and acceleration that keep the direction of the motion.
//
// All four components of a part are scaled together, so that the ROI takes the same path in the image, only slower.
// What has to be limited comes in parts: all of it is scaled until it fits, and then each part, the first ones first,
// grows into the room that is left. A change beyond the acceleration's limit scales the whole change, so that the
// command goes straight from the last one to the wanted one: while it is on the way there, the direction is neither's.
// Both limits hold for each component, whatever is asked for, unless the limits on velocity fall: the new ones are
// reached as fast as the acceleration allows.
#pragma once

#include <initializer_list>

#include "laparoscope_servo/servo/shaping_config.h"

namespace laparoscope_servo::servo {

class SlewLimiter {
 public:
  explicit SlewLimiter(const Limits& limits) : limits_(limits) {}

  // The velocity for a time `dt` [s] >= 0 after the last one. `parts` must be finite; they add up to what is wanted.
  // `scale`, 0 to 1: of the limits on velocity.
  scope::Velocity apply(std::initializer_list<scope::Velocity> parts, double dt, double scale = 1.0);
  scope::Velocity apply(const scope::Velocity& wanted, double dt) { return apply({wanted}, dt); }

  // What was made of the last velocity.
  void applied(const scope::Velocity& velocity) { last_ = velocity; }

  // The last velocity is zero: a safety stop is not slowed down by the limit on acceleration.
  void reset() { last_ = scope::Velocity(); }

 private:
  Limits limits_;
  scope::Velocity last_;
};

}  // namespace laparoscope_servo::servo
