// Parameters of the image input. Defaults are those of config/tracker.yaml.
#pragma once

#include <string>
#include <vector>

namespace laparoscope_servo::parameters {
class Table;
}

namespace laparoscope_servo::tracking {

struct InputConfig {
  // Pictures that repeat. The thresholds between a frozen and a compressed feed were measured, see doc/pictures.md.
  int max_repeats = 1;  // pictures in a row that may repeat in whole, or in a region that moves
  // max_repeats to 1000, in the region alone, while neither images nor robot show that it moves
  int max_still_repeats = 50;
  double moving = 0.5;  // px per image: a region that moved faster counts as moving
  // px: after a larger displacement a repeat is a frozen feed; of the region by the robot, of a part by robot or
  // tracker
  double moved = 2.0;

  // Jumps of stamps and changes of size.
  int restart_images = 3;  // images in a row, after which a new time or a new size is accepted
  double loop_step = 1.0;  // s: a larger step back is a recording that begins again
  double max_gap = 2.0;    // s: an image that is further ahead waits for another one to confirm it
  double max_ahead = 0.1;  // s: of an image's stamp, ahead of this machine's clock
};

// Adds the rows of all parameters, with range and meaning.
void describe(parameters::Table& table, InputConfig& config);
// Of these the rows of jumps and changes of size, which every tracker has. `after_loop`: what it does then.
void describeSequence(parameters::Table& table, InputConfig& config, const std::string& after_loop);

// Every error, each naming the field, its value and what was expected. Empty when the configuration can be used.
std::vector<std::string> validate(const InputConfig& config);

}  // namespace laparoscope_servo::tracking
