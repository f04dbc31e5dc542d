// The robot's dead zone and its inverse.
//
// A robot that does not move below a certain velocity leaves an error behind that a law alone never removes. The
// inverse adds the dead zone's width to what is wanted. Noise about zero becomes motion with it: see rest_band.h.
#pragma once

#include "laparoscope_servo/servo/scope_velocity.h"

namespace laparoscope_servo::servo {

struct DeadZoneConfig {
  bool inverse = true;                               // false: what the law asks for is passed on
  ScopeVelocity width{0.004, 0.004, 0.004, 0.0004};  // rad/s, rad/s, rad/s, m/s: the robot executes nothing below it
};

// What has to be commanded for `wanted` to be executed; below a tenth of the width less is added, so that what crosses
// zero does not jump.
ScopeVelocity throughDeadZone(const ScopeVelocity& wanted, const ScopeVelocity& width);

// What a robot executes of `command`: it loses the width.
ScopeVelocity afterDeadZone(const ScopeVelocity& command, const ScopeVelocity& width);

}  // namespace laparoscope_servo::servo
