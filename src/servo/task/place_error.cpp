#include "laparoscope_servo/servo/place_error.h"

namespace laparoscope_servo::servo {

TaskError placeError(const Eigen::Vector2d& place, const Eigen::Vector2d& desired) {
  TaskError error;
  error.x = place.x();
  error.y = place.y();
  error.desired_x = desired.x();
  error.desired_y = desired.y();
  error.m_star = desired.homogeneous();
  return error;
}

}  // namespace laparoscope_servo::servo
