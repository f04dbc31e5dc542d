#include "laparoscope_servo/tracking/input_config.h"

#include "laparoscope_servo/parameters/table.h"

namespace laparoscope_servo::tracking {

void describe(parameters::Table& table, InputConfig& c) {
  table.number("max_repeats", c.max_repeats, {0, 25}, "images",
               "number in a row that may repeat their picture; with more the feed counts as frozen (SEARCHING)");
  table.number("max_still_repeats", c.max_still_repeats, {0, 1000}, "images",
               "number in a row that may repeat within the region alone while neither images nor robot show that it "
               "moves, since a codec may skip it");
  table.number("moving", c.moving, {0.05, 100}, "px", "a region that moves by more per image counts as moving");
  table.number("moved", c.moved, {0.1, 100}, "px",
               "after a larger displacement a repeat means a frozen feed: of the region by robot_motion, of a part of "
               "it also by the image");
  describeSequence(table, c, "the region is searched as it was selected");
}

void describeSequence(parameters::Table& table, InputConfig& c, const std::string& after_loop) {
  table.number("restart_images", c.restart_images, {2, 100}, "images",
               "number in a row after which an earlier time (a loop) or another size (a camera) is accepted");
  table.number("loop_step", c.loop_step, {0.1, 1e6}, "s", "a larger step back is a loop: " + after_loop);
  table.number("max_gap", c.max_gap, {0.1, 1e6}, "s",
               "an image that is further ahead of the last one is accepted only if the next one agrees");
  table.number("max_ahead", c.max_ahead, {0, 10}, "s",
               "images stamped further ahead of this machine's clock are refused");
}

std::vector<std::string> validate(const InputConfig& config) {
  return parameters::errorsOf(config);
}

}  // namespace laparoscope_servo::tracking
