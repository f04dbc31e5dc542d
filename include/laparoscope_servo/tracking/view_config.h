// What can be set of stored views. Defaults are those of config/tracker.yaml.
#pragma once

#include <string>
#include <vector>

namespace laparoscope_servo::parameters {
class Table;
}

namespace laparoscope_servo::tracking {

struct ViewConfig {
  int capacity = 32;                  // views
  double min_visible_fraction = 0.5;  // of the region while a view is stored: an instrument is no part of a view
  // When a recall goes on from a view on the way to the next one.
  double arrival_centre = 20.0;  // px: distance of the region's centre from its place in the view
  double arrival_scale = 0.1;    // relative difference between the region's scale and that in the view
};

// Rows for all of it: ranges and meanings.
void describe(parameters::Table& table, ViewConfig& config);

// Every error, each naming the field, its value and what was expected. Empty when the configuration can be used.
std::vector<std::string> validate(const ViewConfig& config);

}  // namespace laparoscope_servo::tracking
