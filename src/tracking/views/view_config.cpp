#include "laparoscope_servo/tracking/view_config.h"

#include "laparoscope_servo/parameters/table.h"

namespace laparoscope_servo::tracking {

void describe(parameters::Table& table, ViewConfig& c) {
  table.number("capacity", c.capacity, {1, 256}, "views", "largest number of stored views");
  table.number("min_visible_fraction", c.min_visible_fraction, {0, 1}, "share",
               "of the region that must be visible when a view is stored");
  table.number("arrival_centre", c.arrival_centre, {0.1, 10000}, "px",
               "distance of the region's centre from its place within which a recall goes on to the next view");
  table.number("arrival_scale", c.arrival_scale, {0.001, 1}, "ratio",
               "difference of the region's scale within which a recall goes on to the next view");
  table.number("max_frozen_age", c.max_frozen_age, {1, 3600}, "s",
               "of a frozen picture; in an older one no region can be selected");
}

std::vector<std::string> validate(const ViewConfig& config) {
  return parameters::errorsOf(config);
}

}  // namespace laparoscope_servo::tracking
