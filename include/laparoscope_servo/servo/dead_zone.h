// The inverse of the robot's dead zone, with a stop band.
//
// A robot that does not move below a certain velocity leaves an error behind that the law alone never removes: it asks
// for a velocity that is not executed. The inverse adds the dead zone's width to what the law asks for. Without more it
// would make noise about zero into motion, hence the stop band: an axis at rest starts when the law asks for at least
// `start`, and one that moves stops when the law asks for less than `stop`.
#pragma once

#include <array>

#include "laparoscope_servo/servo/scope_velocity.h"

namespace laparoscope_servo::servo {

// Each in the order and with the units of ScopeVelocity.
struct DeadZoneConfig {
  bool inverse = true;                                 // false: what the law asks for is passed on
  ScopeVelocity width{0.004, 0.004, 0.004, 0.0004};    // the robot executes nothing below it
  ScopeVelocity stop{0.0004, 0.0004, 0.001, 0.0001};   // of the law's velocity: a moving axis stops below it
  ScopeVelocity start{0.0008, 0.0008, 0.005, 0.0002};  // of the law's velocity: an axis at rest starts from it on
};

class DeadZoneInverse {
 public:
  explicit DeadZoneInverse(const DeadZoneConfig& config) : config_(config) {}

  // What has to be commanded for the law's velocity to be executed. Remembers which axes move.
  ScopeVelocity apply(const ScopeVelocity& wanted);

  // All axes are at rest.
  void reset() { moving_.fill(false); }

 private:
  DeadZoneConfig config_;
  std::array<bool, 4> moving_{};
};

}  // namespace laparoscope_servo::servo
