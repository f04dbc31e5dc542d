#include "laparoscope_servo/servo/dead_zone.h"

#include <cmath>

namespace laparoscope_servo::servo {

ScopeVelocity DeadZoneInverse::apply(const ScopeVelocity& wanted) {
  if (!config_.inverse) return wanted;
  const Eigen::Vector4d width = config_.width.vector();
  const Eigen::Vector4d stop = config_.stop.vector();
  const Eigen::Vector4d start = config_.start.vector();
  Eigen::Vector4d command = wanted.vector();
  for (int k = 0; k < 4; ++k) {
    const double speed = std::abs(command[k]);
    bool& moving = moving_[static_cast<std::size_t>(k)];
    moving = speed > 0.0 && speed >= (moving ? stop[k] : start[k]);
    command[k] = moving ? command[k] + std::copysign(width[k], command[k]) : 0.0;
  }
  return ScopeVelocity::fromVector(command);
}

}  // namespace laparoscope_servo::servo
