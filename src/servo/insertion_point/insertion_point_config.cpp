#include "laparoscope_servo/servo/insertion_point_config.h"

#include <sstream>

#include "laparoscope_servo/validation/range_checker.h"

namespace laparoscope_servo::servo {

std::vector<std::string> validate(const InsertionPointConfig& config) {
  validation::RangeChecker check;
  // Not zero: a pose without any noise would weigh infinitely.
  check.range("position_noise", config.position_noise, 1e-6, 0.05, "m");
  check.range("direction_noise", config.direction_noise, 0.0, 0.1, "rad");
  check.range("wobble", config.wobble, 0.0, 0.05, "m");
  check.range("drift", config.drift, 0.0, 0.01, "m/sqrt(s)");
  check.range("same_direction", config.same_direction, 0.0, 0.5, "rad");
  check.range("samples_per_direction", config.samples_per_direction, 1, 1000);
  check.range("max_samples", config.max_samples, 10, 10000);
  check.range("min_samples", config.min_samples, 3, 1000);
  check.range("min_eigenvalue", config.min_eigenvalue, 1e-6, 0.5);
  check.range("residual_samples", config.residual_samples, 1, 1000);
  check.range("warning_residual", config.warning_residual, 1e-4, 0.1, "m");
  check.range("stop_residual", config.stop_residual, 1e-4, 0.1, "m");
  check.range("residual_hysteresis", config.residual_hysteresis, 0.0, 0.9);
  if (config.stop_residual < config.warning_residual) {
    std::ostringstream text;
    text << "stop_residual = " << config.stop_residual
         << ", expected at least warning_residual = " << config.warning_residual;
    check.add(text.str());
  }
  if (config.min_samples > config.max_samples) {
    std::ostringstream text;
    text << "min_samples = " << config.min_samples << ", expected at most max_samples = " << config.max_samples;
    check.add(text.str());
  }
  return check.errors();
}

}  // namespace laparoscope_servo::servo
