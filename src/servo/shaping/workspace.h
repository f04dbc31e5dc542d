// Keeps the scope in its workspace: a range of depths, and a cone of directions about the insertion point.
//
// Motion towards a bound is slowed down and ends at the bound; motion away from it is always allowed.
#pragma once

#include <Eigen/Core>

#include "laparoscope_servo/servo/shaping_config.h"

namespace laparoscope_servo::servo {

// The part of a velocity that is allowed at depth d2 [m] and with these axes of the shaft in the insertion point's
// frame.
scope::Velocity within(const Workspace& range, const scope::Velocity& velocity, double d2,
                       const Eigen::Matrix3d& insertion_point_R_shaft);

// Checks the depth only, for unknown directions.
scope::Velocity within(const Workspace& range, const scope::Velocity& velocity, double d2);

}  // namespace laparoscope_servo::servo
