// Limits on velocity and acceleration that keep the direction of the motion.
//
// All four components of a part are scaled together, so that the ROI takes the same path in the image, only slower. The
// wanted velocity is a sum of parts: first their sum is scaled to fit the limits, then each part in turn is enlarged as
// far as the limits allow. If the change exceeds the limit on acceleration, the whole change is scaled, so that the
// command moves in a straight line from the last velocity to the wanted one. Both limits hold for each component,
// except when the limits on velocity fall: the new ones are then reached as fast as the acceleration allows.
#pragma once

#include <initializer_list>

#include "laparoscope_servo/servo/shaping_config.h"

namespace laparoscope_servo::servo {

class SlewLimiter {
 public:
  explicit SlewLimiter(const Limits& limits) : limits_(limits) {}

  // The velocity for a time `dt` [s] >= 0 after the last one. `parts` must be finite; their sum is the wanted velocity.
  // `scale`, 0 to 1: factor on the limits on velocity.
  scope::Velocity apply(std::initializer_list<scope::Velocity> parts, double dt, double scale = 1.0);
  scope::Velocity apply(const scope::Velocity& wanted, double dt) { return apply({wanted}, dt); }

  // Sets the last velocity, if it was changed after apply().
  void applied(const scope::Velocity& velocity) { last_ = velocity; }

  // Sets the last velocity to zero: a safety stop is not subject to the limit on acceleration.
  void reset() { last_ = scope::Velocity(); }

 private:
  Limits limits_;
  scope::Velocity last_;
};

}  // namespace laparoscope_servo::servo
