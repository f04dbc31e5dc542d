#include "laparoscope_servo/tracking/view_config.h"

#include "laparoscope_servo/validation/range_checker.h"

namespace laparoscope_servo::tracking {

std::vector<std::string> validate(const ViewConfig& c) {
  validation::RangeChecker check;
  check.range("capacity", c.capacity, 1, 256);
  check.range("min_visible_fraction", c.min_visible_fraction, 0.0, 1.0);
  check.range("arrival_centre", c.arrival_centre, 0.1, 10000.0, "px");
  check.range("arrival_scale", c.arrival_scale, 0.001, 1.0);
  return check.errors();
}

}  // namespace laparoscope_servo::tracking
