// Parameters of stored views. Defaults are those of config/tracker.yaml.
#pragma once

#include <string>
#include <vector>

namespace laparoscope_servo::parameters {
class Table;
}

namespace laparoscope_servo::tracking {

struct ViewConfig {
  int capacity = 32;  // views
  // of the region when a view is stored, so that no instrument becomes part of a view
  double min_visible_fraction = 0.5;
  // Limits within which a view counts as reached, so that a recall goes on to the next one.
  // px: distance of the region's centre from its place in the view. The scope has to be slow by then: what it does
  // while the next view is searched has not shown its effect, and uses up effect/unconfirmed_turn of the controller.
  double arrival_centre = 6.0;
  double arrival_scale = 0.1;    // relative difference between the region's scale and that in the view
  double max_frozen_age = 60.0;  // s: of a frozen picture in which a region is drawn
};

// Adds the rows of all parameters, with range and meaning.
void describe(parameters::Table& table, ViewConfig& config);

// Every error, each naming the field, its value and what was expected. Empty when the configuration can be used.
std::vector<std::string> validate(const ViewConfig& config);

}  // namespace laparoscope_servo::tracking
