// Finite motions of the scope about the insertion point, and their effect on the features.
//
// A displacement is (pan, tilt, spin [rad], insertion [m]): the rotation by the vector (tilt, pan, spin) in the shaft's
// axes about O_A, and then the insertion along the shaft.
#pragma once

#include "laparoscope_servo/scope/geometry.h"
#include "laparoscope_servo/servo/task_function.h"

namespace laparoscope_servo::servo {

// The place [m] of a point of the tissue, in the camera's frame, after the scope has moved by `displacement`.
Eigen::Vector3d movedPoint(const Eigen::Vector3d& point, const Eigen::Vector4d& displacement,
                           const scope::Geometry& scope);

// One displacement, and then the other one.
Eigen::Vector4d composed(const Eigen::Vector4d& first, const Eigen::Vector4d& second);

// The task error after the scope has moved by `displacement`, or the target by its opposite. Exact for the ROI's
// centre, at the depth of the features; the orientation is that of an ROI that faces the camera; e_w is correct to
// first order in the rotation. `desired_depth` Z* [m]. Not finite if the centre ends up behind the camera.
TaskError moved(const TaskError& error, const Eigen::Vector4d& displacement, const scope::Geometry& scope,
                double desired_depth);

// The displacement after which the features have their desired values: the inverse of moved(), by Newton's method. Not
// finite if it does not converge.
Eigen::Vector4d displacementToTarget(const TaskError& error, const scope::Geometry& scope, double desired_depth);

}  // namespace laparoscope_servo::servo
