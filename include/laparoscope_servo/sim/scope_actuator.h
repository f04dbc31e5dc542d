// Model between commanded and executed velocity of the scope: the delay of the robot's controller and the dead zone of
// its drives. Deterministic: time is an argument.
#pragma once

#include <Eigen/Core>
#include <deque>
#include <string>
#include <utility>
#include <vector>

namespace laparoscope_servo::parameters {
class Table;
}

namespace laparoscope_servo::sim {

struct ScopeActuatorConfig {
  double delay = 0.16;  // s, from a command to its execution
  // Half the width of the dead zone of pan, tilt, spin [rad/s] and insertion [m/s]; 0: none.
  std::vector<double> dead_zone{0.004, 0.004, 0.004, 0.0004};
  // "subtract": the width is subtracted from velocities above the dead zone, as with friction. "threshold": they are
  // executed unchanged.
  std::string dead_zone_kind = "subtract";
};

// Adds the rows of all parameters, with range and meaning.
void describe(parameters::Table& table, ScopeActuatorConfig& config);

// Every error, each naming the field, its value and what was expected.
std::vector<std::string> validate(const ScopeActuatorConfig& config);

class ScopeActuator {
 public:
  // The configuration must be valid.
  explicit ScopeActuator(const ScopeActuatorConfig& config) : config_(config) {}

  // Takes a command (pan, tilt, spin [rad/s], insertion [m/s]) at `time` [s]; times must not decrease.
  void command(double time, const Eigen::Vector4d& velocity);

  // The velocity executed at `time`, which must not decrease: the last command that is at least `delay` old, zero
  // before the first.
  Eigen::Vector4d velocity(double time);

 private:
  ScopeActuatorConfig config_;
  std::deque<std::pair<double, Eigen::Vector4d>> waiting_;
  Eigen::Vector4d executed_ = Eigen::Vector4d::Zero();
};

}  // namespace laparoscope_servo::sim
