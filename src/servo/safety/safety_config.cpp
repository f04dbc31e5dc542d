#include "laparoscope_servo/servo/safety_config.h"

#include "laparoscope_servo/parameters/table.h"

namespace laparoscope_servo::servo {

namespace {

void describeAges(parameters::Table& table, SafetyConfig& c) {
  table.number("max_task_error_age", c.max_task_error_age, {0.01, 1}, "s",
               "an older task error, or an older image behind it, stops the arm");
  table.number("slow_age", c.slow_age, {0, 1}, "share",
               "of max_task_error_age: above it, the older the image, the slower the scope; 1: not before it stops");
  table.number("max_depth_age", c.max_depth_age, {0.01, 1}, "s",
               "an older tf between insertion point and camera stops the arm");
  table.number("resume_time", c.resume_time, {0, 10}, "s",
               "a hold that ends within it resumes by itself; a longer one disengages");
  table.number("max_period", c.max_period, {0.001, 1}, "s", "one step counts for no more at the limit on acceleration");
  table.number("max_clock_step", c.max_clock_step, {0.01, 10}, "s", "a longer pause between two commands is a fault")
      .atLeast("max_period");
  table.number("max_dead_man_age", c.max_dead_man_age, {0.01, 1}, "s",
               "since the last message; a silent switch counts as released");
  table.number("max_robot_state_age", c.max_robot_state_age, {0.01, 2}, "s",
               "a robot that has said nothing for longer stops the arm");
  table.number("max_manual_age", c.max_manual_age, {0.01, 1}, "s", "in MANUAL the arm stands when ~manual is older");
  table.number("max_manual_repeat", c.max_manual_repeat, {0.5, 3600}, "s",
               "a manual command that is not zero and repeats to the last digit for longer is of a pad out of reach");
  table.number("max_clock_difference", c.max_clock_difference, {0.001, 1}, "s",
               "stamps further ahead do not count, nor do images that are late by less; ROS time that jumps back by "
               "more is a fault");
}

void describeView(parameters::Table& table, SafetyConfig& c) {
  table.number("slow_below", c.slow_below, {0, 1}, "visible fraction", "below it, the less is visible, the slower")
      .atLeast("hold_below");
  table.number("hold_below", c.hold_below, {0, 1}, "visible fraction", "below it, the arm stops");
  table.number("release_hold_above", c.release_hold_above, {0, 1}, "visible fraction", "from it on, the arm goes on")
      .atLeast("hold_below");
  table.number("min_visible_for_insertion", c.min_visible_for_insertion, {0, 1}, "visible fraction",
               "below it, the scope goes no deeper");
  table.number("max_corner_error_for_insertion", c.max_corner_error_for_insertion, {0, 100}, "px",
               "above this corner_error of the tracker, the scope goes no deeper");
  table.number("max_repeated_errors", c.max_repeated_errors, {1, 100}, "task errors",
               "number in a row that repeat to the last digit while the scope moves, from which on the arm stops");
}

}  // namespace

void describe(parameters::Table& table, SafetyConfig& c) {
  describeAges(table, c);
  table.number("min_depth", c.min_depth, {0.005, 0.5}, "m", "a smaller d2 stops the arm");
  table.number("max_depth", c.max_depth, {0.005, 0.5}, "m", "a larger d2 stops the arm").atLeast("min_depth");
  table.number("max_lateral_offset", c.max_lateral_offset, {0, 0.1}, "m",
               "from the insertion point to the shaft; more stops the arm");
  table.number("max_tip_speed", c.max_tip_speed, {0.01, 1000}, "m/s",
               "a scope whose pose by tf moves faster while engaged stops the arm");
  table.number("max_tip_turn", c.max_tip_turn, {0.05, 1000}, "rad/s",
               "a scope whose pose by tf turns faster while engaged stops the arm");
  table.number("max_optics_offset", c.max_optics_offset, {0, 1}, "m",
               "from the shaft's frame to the camera's; more stops the arm");
  describeView(table, c);
  table.flag("dead_man_required", c.dead_man_required, "the topic dead_man must be true while the arm moves");
  table.flag("robot_required", c.robot_required, "the topic operating_state must be ENABLED");
  table.number("manual_neutral", c.manual_neutral, {0, 0.5}, "share",
               "share of limits/velocity up to which a stick counts as released");
}

}  // namespace laparoscope_servo::servo
