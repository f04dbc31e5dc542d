#include "laparoscope_servo/servo/leash_config.h"

#include "laparoscope_servo/parameters/table.h"

namespace laparoscope_servo::servo {

void describe(parameters::Table& table, LeashConfig& c) {
  table.flag("enabled", c.enabled, "false: the region is followed wherever it goes");
  table.number("turn", c.turn, {0.01, 3.2}, "rad", "pan and tilt together, by which the place may wander");
  table.number("spin", c.spin, {0.01, 3.2}, "rad", "about the shaft, by which the place may wander");
  table.number("insertion", c.insertion, {0.001, 0.5}, "m", "along the shaft, by which the place may wander");
  table.number("quick_insertion", c.quick_insertion, {0.001, 0.5}, "m",
               "along the shaft, by which the place may differ from its mean over quick_time");
  table.number("quick_time", c.quick_time, {0.1, 60}, "s", "time constant of that mean");
  table.number("approach", c.approach, {0, 10}, "share",
               "of what is left to go: the leash is at least as long, along the shaft longer by that");
}

}  // namespace laparoscope_servo::servo
