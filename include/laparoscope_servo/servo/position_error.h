// The task error of the task POSITION: 2 1/2 D visual servoing by the homography of a plane, under the constraint of
// the insertion point.
//
// The features are (x, y, log(Z/Z*), (theta u)_z) of the point m*: where it is seen, its depth over that in the
// reference image, and the rotation from the reference to the current camera about the optical axis, both from the
// homography R + t n'/d* (Malis, Chaumette and Boudet, 2 1/2 D visual servoing, 1999). So the depth is that of the
// point also where the plane is slanted, and the turn is that of the camera. The law, applied again and again with a
// rate of one, leads from the reference view to the present one. The error is that of a region about m* whose way back
// is that of the scope, so everything behind it is as for a region.
#pragma once

#include <Eigen/Core>

#include "laparoscope_servo/scope/geometry.h"
#include "laparoscope_servo/servo/task_function.h"

namespace laparoscope_servo::servo {

// Jacobian of the features by the scope's velocity: d(x, y, log depth, (theta u)_z)/dt = J (pan, tilt, spin,
// insertion). `x`, `y` normalised, `depth` Z [m] > 0, `theta_u` [rad]: rotation vector that takes directions in the
// reference camera's frame to those in the current one's, shorter than pi.
Eigen::Matrix4d positionJacobian(double x, double y, double depth, const Eigen::Vector3d& theta_u,
                                 const scope::Geometry& scope);

struct PositionSeen {
  bool is_known = false;  // false: the homography is of no such plane, or no place of the scope has these features
  TaskError error;        // zero unless known
};

// `h`: at any scale and sign, reference to current, normalised coordinates. `m_star`: the point in the reference image,
// normalised, (x, y, 1). `scope`: its optics, and d2 [m] now. `desired_depth`: Z* [m] of the point in the reference
// view; an error of it changes the speed of convergence only.
PositionSeen positionError(const Eigen::Matrix3d& h, const Eigen::Vector3d& m_star, const scope::Geometry& scope,
                           double desired_depth);

}  // namespace laparoscope_servo::servo
