#include "laparoscope_servo/servo/horizon.h"

#include <cmath>

namespace laparoscope_servo::servo {

std::optional<double> horizonAngle(const Eigen::Vector3d& up_in_camera) {
  constexpr double kSmallest = 0.1;  // of the direction's part in the image: below it, noise turns the picture
  const Eigen::Vector3d up = up_in_camera.normalized();
  if (!(up.head<2>().norm() >= kSmallest)) return std::nullopt;
  return std::atan2(up.x(), -up.y());  // upwards is -y
}

}  // namespace laparoscope_servo::servo
