// How far the scope may go: a range of depths, and a cone of directions about the insertion point.
//
// Towards a bound it is slowed down, and at the bound it goes no further; back it may always.
#pragma once

#include <Eigen/Core>

#include "laparoscope_servo/servo/shaping_config.h"

namespace laparoscope_servo::servo {

// What of a velocity is done at a depth d2 [m] with the shaft's axes in the insertion point's frame.
scope::Velocity within(const Workspace& range, const scope::Velocity& velocity, double d2,
                       const Eigen::Matrix3d& insertion_point_R_shaft);

// The same without the cone, where the directions are not known.
scope::Velocity within(const Workspace& range, const scope::Velocity& velocity, double d2);

}  // namespace laparoscope_servo::servo
