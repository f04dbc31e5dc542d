#include "servo/task/horizon.h"

#include <algorithm>
#include <cmath>

namespace laparoscope_servo::servo {

double horizonError(const Eigen::Vector3d& up_in_camera) {
  // Length of the image part of the unit vector "up". An error of the shaft's direction turns the horizon by that error
  // over this length: 0.0035 rad, the noise of a pose, by 1 degree at kWhole and by 2 at kNone. The horizon has weight
  // 0 below kNone and rises to full weight at kWhole; a step would look like a target that jumps.
  constexpr double kNone = 0.1, kWhole = 0.2;
  const Eigen::Vector3d up = up_in_camera.normalized();
  const double share = std::clamp((up.head<2>().norm() - kNone) / (kWhole - kNone), 0.0, 1.0);
  return share > 0.0 ? share * std::atan2(up.x(), -up.y()) : 0.0;  // upwards is -y
}

}  // namespace laparoscope_servo::servo
