#include "laparoscope_servo/servo/insertion_point_config.h"

#include <algorithm>

#include "laparoscope_servo/parameters/table.h"
#include "laparoscope_servo/validation/range_checker.h"

namespace laparoscope_servo::servo {

void describe(parameters::Table& table, InsertionPointConfig& c) {
  table.number("wobble", c.wobble, {0, 0.05}, "m", "standard deviation of the point's motion with breathing");
  table.number("warning_residual", c.warning_residual, {1e-4, 0.1}, "m",
               "distance of the shafts from the point that is a warning");
  table
      .number("stop_residual", c.stop_residual, {1e-4, 0.1}, "m",
              "distance of the shafts from the point that stops the arm")
      .atLeast("warning_residual");
}

std::vector<std::string> validate(const InsertionPointConfig& config) {
  validation::RangeChecker check;
  for (const std::string& error : parameters::errorsOf(config)) check.add(error);
  // Not zero: a pose without noise would have an infinite weight.
  check.range("position_noise", config.position_noise, 1e-6, 0.05, "m");
  check.range("direction_noise", config.direction_noise, 0.0, 0.1, "rad");
  check.range("drift", config.drift, 0.0, 0.01, "m/sqrt(s)");
  check.range("same_direction", config.same_direction, 0.0, 0.5, "rad");
  check.range("samples_per_direction", config.samples_per_direction, 1, 1000);
  check.range("max_samples", config.max_samples, 10, 10000);
  check.range("min_samples", config.min_samples, 3, std::min(1000, std::max(3, config.max_samples)));
  check.range("min_eigenvalue", config.min_eigenvalue, 1e-6, 0.5);
  check.range("residual_samples", config.residual_samples, 1, 1000);
  check.range("residual_hysteresis", config.residual_hysteresis, 0.0, 0.9);
  return check.errors();
}

}  // namespace laparoscope_servo::servo
