#include "laparoscope_servo/servo/harmonic_filter_config.h"

#include "laparoscope_servo/validation/range_checker.h"

namespace laparoscope_servo::servo {

std::vector<std::string> validate(const HarmonicFilterConfig& config) {
  validation::RangeChecker check;
  check.range("min_frequency", config.min_frequency, 0.05, 2.0, "Hz");
  check.range("max_frequency", config.max_frequency, config.min_frequency, 2.0, "Hz");
  check.range("harmonics", config.harmonics, 1, 6);
  check.range("horizon", config.horizon, 0.04, 0.5, "s");
  check.range("window", config.window, 5.0, 60.0, "s");
  check.range("max_gap", config.max_gap, 0.1, 5.0, "s");
  check.range("variation", config.variation, 0.0, 1.0, "1/sqrt(s)");
  check.range("offset_walk", config.offset_walk, 0.0, 100.0, "1/sqrt(s)");
  check.range("frequency_walk", config.frequency_walk, 0.0, 0.1, "1/sqrt(s)");
  check.range("lock_ratio", config.lock_ratio, 0.01, 0.9);
  check.range("unlock_ratio", config.unlock_ratio, config.lock_ratio, 1.0);
  check.range("jump", config.jump, 3.0, 1000.0);
  return check.errors();
}

}  // namespace laparoscope_servo::servo
