// Velocities of a scope that passes through an insertion point: Bourger et al. (2007), eq. (9) to (12). The paper's
// (10) has a typing error, (11) and (12) are missing from its text; the equations here are derived for a rigid body,
// see doc/equations.md.
//
// Along the shaft lie the end-effector's origin O_7, the insertion point O_A and the camera centre O_C, in this order.
// d1 > 0 [m] is from O_7 to O_A, d2 > 0 [m] from O_A to O_C. 0° optics: in camera coordinates O_A = (0, 0, -d2) and
// O_7 = (0, 0, -d1 - d2), and all three frames have parallel axes. Twists are (v [m/s], w [rad/s]), expressed in those
// axes.
#pragma once

#include "laparoscope_servo/geometry/se3.h"
#include "laparoscope_servo/scope/velocity.h"

namespace laparoscope_servo::scope {

// Eq. (9): the twist of the scope at O_A, from that of the camera. Its first two components push the abdominal wall.
geometry::Vector6d twistAtInsertionPoint(const geometry::Vector6d& camera_twist, double d2);

// Eq. (10): the camera's twist when the scope moves by `velocity` and O_A stands still sideways.
geometry::Vector6d cameraTwist(const Velocity& velocity, double d2);

// Eq. (11): the scope's velocity for a wanted camera twist. The translation determines pan and tilt, since the ROI's
// centre must stay in view; w_x and w_y of the wanted twist are ignored. d2 must not be zero.
Velocity aboutInsertionPoint(const geometry::Vector6d& camera_twist, double d2);

// Eq. (12): the twist of the end-effector, at O_7, for a velocity of the scope.
geometry::Vector6d endEffectorTwist(const Velocity& velocity, double d1);

}  // namespace laparoscope_servo::scope
