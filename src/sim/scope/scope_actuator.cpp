#include "laparoscope_servo/sim/scope_actuator.h"

#include <cmath>
#include <sstream>

namespace laparoscope_servo::sim {

std::vector<std::string> validate(const ScopeActuatorConfig& config) {
  std::vector<std::string> errors;
  std::ostringstream error;
  if (!(config.delay >= 0.0 && config.delay <= 2.0)) {
    error << "delay = " << config.delay << ", expected a number from 0 to 2 s";
    errors.push_back(error.str());
  }
  if (config.dead_zone.size() != 4) {
    errors.push_back("dead_zone has " + std::to_string(config.dead_zone.size()) +
                     " elements, expected 4: pan, tilt, spin [rad/s], insertion [m/s]");
  }
  for (const double width : config.dead_zone) {
    if (width >= 0.0 && std::isfinite(width)) continue;
    error.str("");
    error << "dead_zone = " << width << ", expected numbers of at least 0";
    errors.push_back(error.str());
  }
  if (config.dead_zone_kind != "subtract" && config.dead_zone_kind != "threshold") {
    errors.push_back("dead_zone_kind = '" + config.dead_zone_kind + "', expected one of: subtract, threshold");
  }
  return errors;
}

void ScopeActuator::command(double time, const Eigen::Vector4d& velocity) {
  waiting_.emplace_back(time, velocity);
}

Eigen::Vector4d ScopeActuator::velocity(double time) {
  constexpr double kRounding = 1e-9;  // s, of the sum of many steps
  while (!waiting_.empty() && waiting_.front().first + config_.delay <= time + kRounding) {
    executed_ = waiting_.front().second;
    waiting_.pop_front();
  }
  Eigen::Vector4d velocity = executed_;
  for (int k = 0; k < 4; ++k) {
    const double width = config_.dead_zone[static_cast<std::size_t>(k)];
    if (std::abs(velocity[k]) <= width) {
      velocity[k] = 0.0;
    } else if (config_.dead_zone_kind == "subtract") {
      velocity[k] -= std::copysign(width, velocity[k]);
    }
  }
  return velocity;
}

}  // namespace laparoscope_servo::sim
