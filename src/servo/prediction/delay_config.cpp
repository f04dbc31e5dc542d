#include "servo/prediction/delay_config.h"

#include "laparoscope_servo/validation/range_checker.h"

namespace laparoscope_servo::servo {

std::vector<std::string> validate(const DelayConfig& config) {
  validation::RangeChecker check;
  check.range("minimum", config.minimum, 0.0, 1.0, "s");
  check.range("maximum", config.maximum, config.minimum, 1.0, "s");
  check.range("initial", config.initial, config.minimum, config.maximum, "s");
  check.range("lag", config.lag, 0.0, 1.0, "s");
  check.range("window", config.window, 1.0, 60.0, "s");
  check.range("period", config.period, 0.01, 10.0, "s");
  check.range("step", config.step, 0.002, 0.1, "s");
  check.range("max_rate", config.max_rate, 0.0, 1.0, "s/s");
  check.range("max_gap", config.max_gap, 0.05, 10.0, "s");
  check.range("min_correlation", config.min_correlation, 0.1, 1.0);
  check.range("max_stddev", config.max_stddev, 1e-4, 0.2, "s");
  // Not zero: noise would otherwise count as a command.
  check.range("min_excitation/pan", config.min_excitation.pan, 1e-5, 1.0, "rad/s");
  check.range("min_excitation/tilt", config.min_excitation.tilt, 1e-5, 1.0, "rad/s");
  check.range("min_excitation/spin", config.min_excitation.spin, 1e-5, 1.0, "rad/s");
  check.range("min_excitation/insertion", config.min_excitation.insertion, 1e-6, 0.1, "m/s");
  return check.errors();
}

}  // namespace laparoscope_servo::servo
