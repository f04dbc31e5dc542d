#include "laparoscope_servo/features/points.h"
#include "laparoscope_servo/parameters/table.h"

namespace laparoscope_servo::features {

void describe(parameters::Table& table, PointsConfig& c) {
  table.number("window", c.window, {9, 61}, "px", "side of the window around a point that is compared; odd");
  table.number("levels", c.levels, {1, 7}, "",
               "of the pyramid; with each one more a point may move twice as far from image to image");
  table.number("corner_quality", c.corner_quality, {0.0001, 1}, "",
               "weakest corner that is chosen, relative to the strongest");
  table.number("min_distance", c.min_distance, {1, 200}, "px", "between corners that are chosen");
  table.number("saturation", c.saturation, {128, 256}, "grey levels",
               "pixels as bright in any channel are not compared; 256: all are");
  table.number("min_correlation", c.min_correlation, {0, 1}, "", "with the first view");
  table.number("min_share", c.min_share, {0.1, 1}, "", "of the window's texture that agrees with the first view");
  table.number("max_error", c.max_error, {0.01, 20}, "px", "standard deviation expected of a point");
  table.number("max_scale", c.max_scale, {1, 8}, "", "by which a window may grow or shrink since the first view");
  table.number("max_distortion", c.max_distortion, {1, 10}, "", "ratio of a window's growth along two directions");
  table.number("search_range", c.search_range, {2, 100}, "px",
               "how far from where the others say a point is looked for that is not seen");
  table.number(
      "recall_period", c.recall_period, {0, 600}, "s",
      "how often the first view is matched as a whole while fewer than three of its points are seen; 0: never");
  describe(table, c.state);
}

std::vector<std::string> validate(const PointsConfig& config) {
  std::vector<std::string> errors = parameters::errorsOf(config);
  if (config.window % 2 == 0)
    errors.push_back("window = " + std::to_string(config.window) + ", expected an odd number");
  return errors;
}

}  // namespace laparoscope_servo::features
