#include "servo/shaping/dead_zone.h"

#include <algorithm>
#include <cmath>

namespace laparoscope_servo::servo {

scope::Velocity throughDeadZone(const scope::Velocity& wanted, const scope::Velocity& width) {
  constexpr double kSteep = 10.0;
  Eigen::Vector4d command = wanted.vector();
  for (int k = 0; k < 4; ++k) {
    command[k] += std::copysign(std::min(width.vector()[k], kSteep * std::abs(command[k])), command[k]);
  }
  return scope::Velocity::fromVector(command);
}

scope::Velocity afterDeadZone(const scope::Velocity& command, const scope::Velocity& width) {
  Eigen::Vector4d executed = command.vector();
  for (int k = 0; k < 4; ++k) {
    executed[k] = std::copysign(std::max(std::abs(executed[k]) - width.vector()[k], 0.0), executed[k]);
  }
  return scope::Velocity::fromVector(executed);
}

}  // namespace laparoscope_servo::servo
