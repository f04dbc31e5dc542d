#include "laparoscope_servo/sim/scope_actuator.h"

#include "laparoscope_servo/parameters/table.h"

namespace laparoscope_servo::sim {

void describe(parameters::Table& table, ScopeActuatorConfig& c) {
  table.number("delay", c.delay, {0, 2}, "s", "from a command to its execution");
  table.numbers("dead_zone", c.dead_zone, 4, {0, 1}, "rad/s, m/s",
                "pan, tilt, spin, insertion: slower commands are not executed");
  table.choice("dead_zone_kind", c.dead_zone_kind, {"subtract", "threshold"},
               "faster commands lose the dead zone's width, or are executed as they are");
}

std::vector<std::string> validate(const ScopeActuatorConfig& config) {
  return parameters::errorsOf(config);
}

void ScopeActuator::command(double time, const Eigen::Vector4d& velocity) {
  waiting_.emplace_back(time, velocity);
}

Eigen::Vector4d ScopeActuator::velocity(double time) {
  constexpr double kRounding = 1e-9;  // s, rounding of the sum of many steps
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
