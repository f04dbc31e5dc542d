#include "laparoscope_servo/tracking/input_config.h"

#include "laparoscope_servo/parameters/table.h"

namespace laparoscope_servo::tracking {

void describe(parameters::Table& table, InputConfig& c) {
  table.number("max_repeats", c.max_repeats, {0, 25}, "images",
               "as many in a row may repeat their picture before the feed is taken to stand still: SEARCHING");
  table.number("max_still_repeats", c.max_still_repeats, {0, 1000}, "images",
               "as many in a row may repeat within the region alone, while nothing says that it moves (a codec skips)");
  table.number("moving", c.moving, {0.05, 100}, "px", "a region that moved by more in an image was moving");
  table.number("moved", c.moved, {0.1, 100}, "px",
               "what moved by more cannot look as before: the region by robot_motion, a part of it by the image, too");
  table.number("restart_images", c.restart_images, {2, 100}, "images",
               "as many in a row until an earlier time (a loop) or another size (a camera) is believed");
  table.number("loop_step", c.loop_step, {0.1, 1e6}, "s",
               "a larger step back is a loop: the region is looked for again where it was selected");
  table.number("max_gap", c.max_gap, {0.1, 1e6}, "s",
               "an image that is further ahead of the last one is believed when the next one agrees");
  table.number("max_ahead", c.max_ahead, {0, 10}, "s",
               "images stamped further ahead of this machine's clock are refused");
}

std::vector<std::string> validate(const InputConfig& config) {
  return parameters::errorsOf(config);
}

}  // namespace laparoscope_servo::tracking
