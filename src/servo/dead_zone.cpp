#include "laparoscope_servo/servo/dead_zone.h"

#include <algorithm>
#include <cmath>

namespace laparoscope_servo::servo {

ScopeVelocity throughDeadZone(const ScopeVelocity& wanted, const ScopeVelocity& width) {
  constexpr double kSteep = 10.0;
  Eigen::Vector4d command = wanted.vector();
  for (int k = 0; k < 4; ++k) {
    command[k] += std::copysign(std::min(width.vector()[k], kSteep * std::abs(command[k])), command[k]);
  }
  return ScopeVelocity::fromVector(command);
}

ScopeVelocity afterDeadZone(const ScopeVelocity& command, const ScopeVelocity& width) {
  Eigen::Vector4d executed = command.vector();
  for (int k = 0; k < 4; ++k) {
    executed[k] = std::copysign(std::max(0.0, std::abs(executed[k]) - width.vector()[k]), executed[k]);
  }
  return ScopeVelocity::fromVector(executed);
}

}  // namespace laparoscope_servo::servo
