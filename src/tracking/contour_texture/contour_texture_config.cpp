#include "laparoscope_servo/parameters/table.h"
#include "laparoscope_servo/tracking/contour_texture.h"

namespace laparoscope_servo::tracking {

void describe(parameters::Table& table, ContourTextureConfig& c) {
  table.flag("texture", c.texture, "the grey levels inside of the contour count");
  table.flag("contour", c.contour, "the edges along it count; one of the two has to");
  table.number("min_block_share", c.min_block_share, {0.1, 1}, "",
               "of the blocks with texture, that correlate with the reference");
  table.number("min_correlation", c.min_correlation, {0.3, 1}, "", "of a block that does");
  table.number("max_corner_error", c.max_corner_error, {0.1, 100}, "px",
               "standard deviation expected of the worst corner of the contour's box");
  table.group("edges", "of the contour", [&] { describe(table, c.edges); });
}

std::vector<std::string> validate(const ContourTextureConfig& config) {
  std::vector<std::string> errors = parameters::errorsOf(config);
  if (!config.texture && !config.contour)
    errors.emplace_back("contour = false beside texture = false, expected one of them true");
  return errors;
}

}  // namespace laparoscope_servo::tracking
