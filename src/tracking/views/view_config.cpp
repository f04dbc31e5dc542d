#include "laparoscope_servo/tracking/view_config.h"

#include "laparoscope_servo/parameters/table.h"

namespace laparoscope_servo::tracking {

void describe(parameters::Table& table, ViewConfig& c) {
  table.number("capacity", c.capacity, {1, 256}, "views", "as many can be stored");
  table.number("min_visible_fraction", c.min_visible_fraction, {0, 1}, "share",
               "of the region that has to be visible while a view is stored");
  table.number("arrival_centre", c.arrival_centre, {0.1, 10000}, "px",
               "a recall goes on to the next view when the region's centre is as near to its place");
  table.number("arrival_scale", c.arrival_scale, {0.001, 1}, "ratio",
               "a recall goes on to the next view when the region's scale differs by no more");
}

std::vector<std::string> validate(const ViewConfig& config) {
  return parameters::errorsOf(config);
}

}  // namespace laparoscope_servo::tracking
