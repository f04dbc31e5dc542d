#include "laparoscope_servo/tracking/input_config.h"

#include "laparoscope_servo/validation/range_checker.h"

namespace laparoscope_servo::tracking {

std::vector<std::string> validate(const InputConfig& c) {
  validation::RangeChecker check;
  check.range("max_repeats", c.max_repeats, 0, 25);
  check.range("max_still_repeats", c.max_still_repeats, 0, 1000);
  check.range("moving", c.moving, 0.05, 100.0, "px");
  check.range("moved", c.moved, 0.1, 100.0, "px");
  check.range("restart_images", c.restart_images, 2, 100);
  check.range("loop_step", c.loop_step, 0.1, 1e6, "s");
  check.range("max_gap", c.max_gap, 0.1, 1e6, "s");
  check.range("max_ahead", c.max_ahead, 0.0, 10.0, "s");
  return check.errors();
}

}  // namespace laparoscope_servo::tracking
