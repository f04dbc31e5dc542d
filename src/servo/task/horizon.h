// The horizon: how the picture stands to what is up in space.
#pragma once

#include <Eigen/Core>

namespace laparoscope_servo::servo {

// rad in [-pi, pi]: by how much the direction `up_in_camera` (camera coordinates, any length) is turned in the image
// from upwards, positive from x (right) to y (down), like alpha of the features. Where the camera looks along it,
// nothing in the image is up: the error fades from 12 degrees on and is 0 from 6.
double horizonError(const Eigen::Vector3d& up_in_camera);

}  // namespace laparoscope_servo::servo
