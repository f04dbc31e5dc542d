// The horizon: the angle in the image between upwards and the direction "up" in space.
#pragma once

#include <Eigen/Core>

namespace laparoscope_servo::servo {

// rad in [-pi, pi]: angle in the image from upwards to `up_in_camera` (camera coordinates, any length), positive from x
// (right) to y (down), like alpha of the features. It is not defined when the camera looks along that direction: within
// 12 degrees of it the error is reduced, and within 6 degrees it is 0.
double horizonError(const Eigen::Vector3d& up_in_camera);

}  // namespace laparoscope_servo::servo
