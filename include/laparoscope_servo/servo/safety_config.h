// What the safety states ask for before they let the scope move, with the defaults that config/controller.yaml repeats.
#pragma once

namespace laparoscope_servo::parameters {
class Table;
}

namespace laparoscope_servo::servo {

struct SafetyConfig {
  double max_task_error_age = 0.25;   // s, of the last task error and of the image behind it; older ones stop the arm
  double max_depth_age = 0.25;        // s, an older d2 stops the arm
  double min_depth = 0.02;            // m, d2 below it stops the arm
  double max_depth = 0.25;            // m, d2 above it stops the arm
  double max_lateral_offset = 0.015;  // m, from the insertion point to the shaft; beyond it the arm stops
  double max_tip_speed = 0.15;        // m/s, a scope whose pose changes faster is not the arm's doing
  double max_tip_turn = 1.0;          // rad/s, the same
  double max_optics_offset = 0.005;   // m, from the shaft's frame to the camera's: both are at the tip
  double resume_time = 2.0;           // s, a hold that ends within it resumes by itself; a longer one disengages
  double max_period = 0.1;            // s, the most that one step counts for the limit on acceleration
  double max_clock_step = 1.0;        // s, a longer pause between two steps is a jump of the clock

  // Visible fractions of the region of interest, 0 to 1.
  double slow_below = 0.5;           // the less is visible, the slower: full speed here, none at hold_below
  double hold_below = 0.2;           // the arm stops
  double release_hold_above = 0.25;  // and goes on from here
  double min_visible_for_insertion = 0.5;
  double max_corner_error_for_insertion = 1.0;  // px, expected error of the worst corner

  bool dead_man_required = false;     // a switch that has to be pressed while the arm moves
  double max_dead_man_age = 0.2;      // s, since its last word; a silent one counts as released
  bool robot_required = true;         // the robot has to say that it is enabled
  double max_robot_state_age = 0.3;   // s, since its last word
  double max_manual_age = 0.2;        // s, a manual command that is older is none: the arm stands
  double max_manual_repeat = 5.0;     // s, one that is not zero and repeats for longer is of a pad out of reach
  double manual_neutral = 0.02;       // share of the limits on velocity, up to which a stick is taken to be released
  int max_repeated_errors = 3;        // task errors that repeat to the last digit while the scope moves
  double max_clock_difference = 0.1;  // s, by which the clocks of two machines may differ
};

// Rows for all of it: ranges and meanings.
void describe(parameters::Table& table, SafetyConfig& config);

}  // namespace laparoscope_servo::servo
