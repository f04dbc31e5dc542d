// The robot's dead zone and its inverse.
//
// A robot that does not move below a certain velocity leaves a steady error. The inverse adds the dead zone's width to
// the wanted velocity. It also turns noise about zero into motion, which hysteresis_band.h prevents.
#pragma once

#include "laparoscope_servo/scope/velocity.h"

namespace laparoscope_servo::servo {

// The command for which the robot executes `wanted`. Below a tenth of the width less is added, so that the command does
// not jump at zero.
scope::Velocity throughDeadZone(const scope::Velocity& wanted, const scope::Velocity& width);

// The velocity that the robot executes for `command`: the width is subtracted.
scope::Velocity afterDeadZone(const scope::Velocity& command, const scope::Velocity& width);

}  // namespace laparoscope_servo::servo
