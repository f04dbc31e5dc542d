#include "laparoscope_servo/motion/motion_config.h"

#include "laparoscope_servo/parameters/table.h"

namespace laparoscope_servo::motion {

void describe(parameters::Table& table, MotionConfig& c) {
  table.choice("model", c.model, {"constant", "affine", "quadratic"},
               "of the motion: a shift (2 parameters), also zoom, turn and shear (6), or that of a plane (8)");
  table.number("max_pixels", c.max_pixels, {10000, 1e7}, "px", "an image with more is used at half its size, or less");
  table.flag("light", c.light, "one gain and one offset of the light are estimated, too");
  table.number("saturation", c.saturation, {1, 256}, "grey levels",
               "from there on in any channel a pixel is a highlight, and left out; 256: none is");
  table.number("darkness", c.darkness, {0, 255}, "grey levels",
               "where no channel has more nothing is seen: the border beyond the picture, shadows");
  table.number("min_usable", c.min_usable, {0.01, 1}, "",
               "share of the image, or of the region, that highlights, darkness and masks have to leave");
  table.number("min_share", c.min_share, {0.05, 1}, "",
               "of the gradient energy, that has to follow the motion for it to dominate");
  table.number("max_error", c.max_error, {0.01, 20}, "px", "standard deviation expected at the worst corner");
  table.number("velocity_damping", c.velocity_damping, {0, 1}, "",
               "share of the last motion that is expected to go on");
  describe(table, c.state);
}

std::vector<std::string> validate(const MotionConfig& config) {
  return parameters::errorsOf(config);
}

}  // namespace laparoscope_servo::motion
