// The robot's dead zone and its inverse.
//
// A robot that does not move below a certain velocity leaves an error behind that a law alone never removes. The
// inverse adds the dead zone's width to what is wanted. Noise about zero becomes motion with it: see hysteresis_band.h.
#pragma once

#include "laparoscope_servo/scope/velocity.h"

namespace laparoscope_servo::servo {

// What has to be commanded for `wanted` to be executed; below a tenth of the width less is added, so that what crosses
// zero does not jump.
scope::Velocity throughDeadZone(const scope::Velocity& wanted, const scope::Velocity& width);

// What a robot executes of `command`: it loses the width.
scope::Velocity afterDeadZone(const scope::Velocity& command, const scope::Velocity& width);

}  // namespace laparoscope_servo::servo
