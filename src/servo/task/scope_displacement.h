// Finite motions of the scope about the insertion point, and what they do to the features.
//
// A displacement is (pan, tilt, spin [rad], insertion [m]): the rotation by the vector (tilt, pan, spin) in the shaft's
// axes about O_A, and then the insertion along the shaft.
#pragma once

#include "laparoscope_servo/scope/geometry.h"
#include "laparoscope_servo/servo/task_function.h"

namespace laparoscope_servo::servo {

// The task error after the scope has moved by `displacement`, or the target by its opposite. Exact for the centre of
// the ROI, which lies at the depth of the features; for its orientation as if the ROI faced the camera; e_w to first
// order in the rotation. `desired_depth` Z* [m]. Not finite where the centre ends up behind the camera.
TaskError moved(const TaskError& error, const Eigen::Vector4d& displacement, const scope::Geometry& scope,
                double desired_depth);

// The displacement after which the features are the desired ones: the inverse of moved, by Newton's method. Not finite
// where it does not converge.
Eigen::Vector4d displacementToTarget(const TaskError& error, const scope::Geometry& scope, double desired_depth);

}  // namespace laparoscope_servo::servo
