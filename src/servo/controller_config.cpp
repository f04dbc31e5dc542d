#include "laparoscope_servo/servo/controller_config.h"

#include <cmath>
#include <limits>
#include <sstream>

#include "laparoscope_servo/validation/range_checker.h"

namespace laparoscope_servo::servo {

namespace {

class Checker : public validation::RangeChecker {
 public:
  using RangeChecker::range;

  // `angular` bounds pan, tilt and spin, `linear` bounds insertion.
  void range(const std::string& group, const ScopeVelocity& value, double minimum, double angular, double linear,
             const std::string& derivative) {
    range(group + "/pan", value.pan, minimum, angular, "rad/" + derivative);
    range(group + "/tilt", value.tilt, minimum, angular, "rad/" + derivative);
    range(group + "/spin", value.spin, minimum, angular, "rad/" + derivative);
    range(group + "/insertion", value.insertion, minimum, linear, "m/" + derivative);
  }

  void atLeast(const std::string& name, double value, const std::string& other_name, double other) {
    if (!(value < other)) return;
    std::ostringstream error;
    error << name << " = " << value << ", expected at least " << other_name << " = " << other;
    add(error.str());
  }
};

void checkDeadZone(const DeadZoneConfig& config, Checker& check) {
  check.range("dead_zone/width", config.width, 0.0, 0.1, 0.02, "s");
  check.range("dead_zone/stop", config.stop, 0.0, 0.1, 0.02, "s");
  check.range("dead_zone/start", config.start, 0.0, 0.1, 0.02, "s");
  check.atLeast("dead_zone/start/pan", config.start.pan, "dead_zone/stop/pan", config.stop.pan);
  check.atLeast("dead_zone/start/tilt", config.start.tilt, "dead_zone/stop/tilt", config.stop.tilt);
  check.atLeast("dead_zone/start/spin", config.start.spin, "dead_zone/stop/spin", config.stop.spin);
  check.atLeast("dead_zone/start/insertion", config.start.insertion, "dead_zone/stop/insertion", config.stop.insertion);
}

void checkSafety(const SafetyConfig& config, Checker& check) {
  check.range("safety/max_task_error_age", config.max_task_error_age, 0.01, 1.0, "s");
  check.range("safety/max_depth_age", config.max_depth_age, 0.01, 1.0, "s");
  check.range("safety/min_depth", config.min_depth, 0.005, 0.5, "m");
  check.range("safety/max_depth", config.max_depth, 0.005, 0.5, "m");
  check.atLeast("safety/max_depth", config.max_depth, "safety/min_depth", config.min_depth);
  check.range("safety/max_lateral_offset", config.max_lateral_offset, 0.0, 0.1, "m");
  check.range("safety/resume_time", config.resume_time, 0.0, 10.0, "s");
  check.range("safety/max_period", config.max_period, 0.001, 1.0, "s");
  check.range("safety/max_clock_step", config.max_clock_step, 0.01, 10.0, "s");
  check.atLeast("safety/max_clock_step", config.max_clock_step, "safety/max_period", config.max_period);
  check.range("safety/slow_below", config.slow_below, 0.0, 1.0);
  check.range("safety/hold_below", config.hold_below, 0.0, 1.0);
  check.atLeast("safety/slow_below", config.slow_below, "safety/hold_below", config.hold_below);
  check.range("safety/release_hold_above", config.release_hold_above, 0.0, 1.0);
  check.atLeast("safety/release_hold_above", config.release_hold_above, "safety/hold_below", config.hold_below);
  check.range("safety/min_visible_for_insertion", config.min_visible_for_insertion, 0.0, 1.0);
  check.range("safety/max_corner_error_for_insertion", config.max_corner_error_for_insertion, 0.0, 100.0, "px");
  check.range("safety/max_dead_man_age", config.max_dead_man_age, 0.01, 1.0, "s");
  check.range("safety/max_robot_state_age", config.max_robot_state_age, 0.01, 2.0, "s");
}

}  // namespace

std::vector<std::string> validate(const ControllerConfig& config) {
  Checker check;
  // No negative gain: it would drive the arm away from the target.
  check.range("gains/pan", config.gains.pan, 0.0, 5.0, "1/s");
  check.range("gains/tilt", config.gains.tilt, 0.0, 5.0, "1/s");
  check.range("gains/spin", config.gains.spin, 0.0, 5.0, "1/s");
  check.range("gains/insertion", config.gains.insertion, 0.0, 0.5, "m/s");
  checkDeadZone(config.dead_zone, check);
  // Not zero: since all components are scaled together, it would stop the others too. A gain of zero keeps one still.
  check.range("limits/velocity", config.limits.velocity, 1e-6, 1.0, 0.1, "s");
  check.range("limits/acceleration", config.limits.acceleration, 1e-6, 100.0, 10.0, "s^2");
  checkSafety(config.safety, check);
  return check.errors();
}

}  // namespace laparoscope_servo::servo
