// Positions of camera and insertion point on the scope.
//
// The shaft's frame has its z axis along the shaft into the body; pan, tilt and spin are rotations about its y, x and z
// axes through the insertion point O_A, insertion is along z. The camera centre O_C lies on the shaft, d2 from O_A.
// With 0° optics the camera's axes are the shaft's; with oblique optics the camera looks to the side.
#pragma once

#include <Eigen/Core>

#include "laparoscope_servo/geometry/se3.h"
#include "laparoscope_servo/scope/velocity.h"

namespace laparoscope_servo::scope {

struct Geometry {
  Eigen::Matrix3d camera_R_shaft = Eigen::Matrix3d::Identity();  // the shaft's axes in camera coordinates
  double d2 = 0.1;                                               // m > 0, from O_A to O_C
};

// Angular velocity (tilt, pan, spin) of the shaft, in its own axes.
inline Eigen::Vector3d angularVelocity(const Velocity& velocity) {
  return {velocity.tilt, velocity.pan, velocity.spin};
}

// The 6x4 matrix that takes (pan, tilt, spin, insertion) to the camera's twist (v, w) in camera coordinates: eq. (10)
// of Bourger et al. (2007), turned by the optics.
Eigen::Matrix<double, 6, 4> insertionPointMotions(const Geometry& scope);

// Oblique optics that look `angle` [rad] to the side of the shaft, downwards in the image's reading direction at 0
// `roll` [rad]: the camera is turned by the angle about its x axis, then all of it by the roll about the shaft.
Eigen::Matrix3d obliqueOptics(double angle, double roll = 0.0);

}  // namespace laparoscope_servo::scope
