#include "laparoscope_servo/servo/effect_config.h"

#include "laparoscope_servo/parameters/table.h"

namespace laparoscope_servo::servo {

void describe(parameters::Table& table, EffectConfig& c) {
  table.flag("enabled", c.enabled, "false: nothing watches what the motion does to the picture");
  // Not zero: if the tissue could not move by itself, every breath would count as a fault.
  table.number("tissue_centre", c.tissue_centre, {1e-3, 10}, "1/s",
               "px over the focal length a second: how fast tissue moves by itself, standard deviation");
  table.number("tissue_depth", c.tissue_depth, {1e-3, 10}, "1/s",
               "of the log depth: how fast tissue moves by itself, standard deviation");
  table.number("tissue_orientation", c.tissue_orientation, {1e-3, 10}, "rad/s",
               "how fast tissue turns by itself, standard deviation");
  table.number("tissue_time", c.tissue_time, {0.05, 60}, "s", "for which tissue keeps its velocity");
  table.number("unrest_time", c.unrest_time, {0, 10}, "s", "for which tissue that moves otherwise is not judged by");
  table.number("memory", c.memory, {0.1, 60}, "s", "over which images are forgotten");
  table
      .number("doubt", c.doubt, {1, 100}, "log likelihood ratio",
              "of a fault over none, from which on the scope stands")
      .atLeast("release");
  table.number("release", c.release, {0, 100}, "log likelihood ratio", "below which the scope goes on");
  table.number("certain", c.certain, {1, 1000}, "log likelihood ratio", "that is a FAULT once the scope stands")
      .atLeast("doubt");
  table.number("standing_time", c.standing_time, {0.05, 10}, "s",
               "from the doubt until the scope stands and that is seen");
  table.number("unconfirmed_turn", c.unconfirmed_turn, {1e-3, 10}, "rad",
               "that the scope may turn before its effect was seen");
  table.number("unconfirmed_insertion", c.unconfirmed_insertion, {1e-4, 1}, "m",
               "that the scope may go in or out before its effect was seen");
}

}  // namespace laparoscope_servo::servo
