#include "laparoscope_servo/features/edge_config.h"

#include "laparoscope_servo/parameters/table.h"

namespace laparoscope_servo::features {

void describe(parameters::Table& table, EdgeConfig& c) {
  table.number("spacing", c.spacing, {1, 50}, "px", "from site to site along the curve");
  table.number("max_sites", c.max_sites, {16, 1000}, "sites", "a longer curve has them further apart");
  table.number("range", c.range, {6, 100}, "px",
               "searched along the normal, either side of where the curve is expected");
  table.number("min_contrast", c.min_contrast, {1, 255}, "grey levels", "across an edge; less is taken for noise");
  table.number("min_similarity", c.min_similarity, {0.05, 1}, "",
               "of an edge's contrast to the one remembered there: the smaller over the larger");
  table.number("min_share", c.min_share, {0.1, 1}, "", "of the sites in the image, that agree with the curve");
  table.number("min_return_share", c.min_return_share, {0.1, 1}, "", "as min_share, to be believed again after a loss");
  table.number("max_error", c.max_error, {0.05, 20}, "px", "standard deviation expected of the worst site");
  table.number("max_change", c.max_change, {0.01, 1}, "", "of size or shape, from one image to the next");
  table.number("velocity_damping", c.velocity_damping, {0, 1}, "",
               "share of the last motion that is expected to go on");
  describe(table, c.state);
}

std::vector<std::string> validate(const EdgeConfig& config) {
  return parameters::errorsOf(config);
}

}  // namespace laparoscope_servo::features
