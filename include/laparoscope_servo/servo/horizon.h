// The horizon: how the picture stands to what is up in space.
#pragma once

#include <Eigen/Core>
#include <optional>

namespace laparoscope_servo::servo {

// rad in (-pi, pi]: by how much the direction `up_in_camera` (camera coordinates, any length) is turned in the image from upwards, positive from
// x (right) to y (down), like alpha of the features. Nothing when the camera looks along it, within some 6 degrees.
std::optional<double> horizonAngle(const Eigen::Vector3d& up_in_camera);

}  // namespace laparoscope_servo::servo
