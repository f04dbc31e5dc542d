#include "ros/joystick/stick_config.h"

namespace laparoscope_servo {

namespace {

const validation::Range kNumber{-1, 255};  // the API counts in a byte

void describeAxis(parameters::Table& table, const std::string& name, StickConfig::Axis& axis, double most,
                  const std::string& unit, const std::string& meaning) {
  table.group(name, meaning, [&] {
    table.number("axis", axis.axis, kNumber, "", "number of the axis; -1: none");
    table.flag("reversed", axis.reversed, "left or up is positive");
    table.number("velocity", axis.velocity, {0, most}, unit,
                 "at full deflection; limits/velocity of controller bounds it");
  });
}

}  // namespace

void describe(parameters::Table& table, StickConfig& c) {
  describeAxis(table, "pan", c.pan, 1, "rad/s", "positive: the view goes right");
  describeAxis(table, "tilt", c.tilt, 1, "rad/s", "positive: the view goes up");
  describeAxis(table, "spin", c.spin, 1, "rad/s", "positive: the camera turns clockwise");
  describeAxis(table, "insertion", c.insertion, 0.1, "m/s", "positive: deeper");
  table.number("neutral", c.neutral, {0.01, 0.9}, "share", "of an axis' travel up to which it counts as released");
  table.group("dead_man", "the switch at the hand", [&] {
    table.number("button", c.dead_man_button, kNumber, "", "that is held while the scope may move; -1: none");
  });
  table.group("pedal", "a switch at the foot, which does the same", [&] {
    table.number("button", c.pedal_button, kNumber, "", "of a pedal that is a button; -1: none");
    table.number("axis", c.pedal_axis, kNumber, "", "of a pedal that is an axis; -1: none");
    table.flag("reversed", c.pedal_reversed, "the axis is at its upper end while the pedal is not pressed");
    table.number("pressed", c.pedal_pressed, {0.1, 1}, "share",
                 "of the pedal's travel from which it counts as pressed");
  });
  table.flag("only_while_held", c.only_while_held, "axes are published only while button or pedal is held");
  table.number("max_silence", c.max_silence, {0.5, 3600}, "s",
               "without any event while something is held or deflected; the device then counts as out of reach, and "
               "nothing is published until all was released");
}

std::vector<std::string> validate(const StickConfig& config) {
  std::vector<std::string> errors = parameters::errorsOf(config);
  const bool has_switch = config.dead_man_button >= 0 || config.pedal_button >= 0 || config.pedal_axis >= 0;
  if (config.only_while_held && !has_switch)
    errors.push_back(
        "only_while_held = true, expected a number >= 0 for dead_man/button, pedal/button or pedal/axis with it");
  return errors;
}

}  // namespace laparoscope_servo
