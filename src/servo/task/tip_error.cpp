#include "laparoscope_servo/servo/tip_error.h"

namespace laparoscope_servo::servo {

TaskError tipError(const Eigen::Vector2d& tip, const CentreTipConfig& config) {
  TaskError error;
  error.x = tip.x();
  error.y = tip.y();
  error.desired_x = config.x;
  error.desired_y = config.y;
  error.m_star = {config.x, config.y, 1.0};
  return error;
}

}  // namespace laparoscope_servo::servo
