// What can be set of how images are taken in. Defaults are those of config/tracker.yaml.
#pragma once

#include <string>
#include <vector>

namespace laparoscope_servo::parameters {
class Table;
}

namespace laparoscope_servo::tracking {

struct InputConfig {
  // Of pictures that repeat. The line between a feed that stands still and one that is compressed was measured, see
  // doc/pictures.md.
  int max_repeats = 1;         // pictures in a row that may repeat in whole, or in a region that moves
  int max_still_repeats = 15;  // max_repeats to 1000, in the region alone, while nothing says that it should move
  double moving = 0.5;         // px, an image: a region that moved by more before was moving
  double moved = 2.0;  // px: what has moved by more cannot look the same: the region by the robot, a part by either

  // Of stamps and sizes that do not go on as those before.
  int restart_images = 3;  // images in a row, after which another time, or another size, is believed
  double loop_step = 1.0;  // s: a larger step back is a recording that begins again
  double max_gap = 2.0;    // s: an image that is further ahead waits for another one to confirm it
  double max_ahead = 0.1;  // s: of an image's stamp, ahead of this machine's clock
};

// Rows for all of it: ranges and meanings.
void describe(parameters::Table& table, InputConfig& config);

// Every error, each naming the field, its value and what was expected. Empty when the configuration can be used.
std::vector<std::string> validate(const InputConfig& config);

}  // namespace laparoscope_servo::tracking
