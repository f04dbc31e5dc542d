// Parameters of the safety states, with the defaults that config/controller.yaml repeats.
#pragma once

namespace laparoscope_servo::parameters {
class Table;
}

namespace laparoscope_servo::servo {

struct SafetyConfig {
  double max_task_error_age = 0.25;   // s, of the last task error and of its image; older ones stop the arm
  double slow_age = 0.4;              // share of it from which on the scope is slower, the older the image
  double max_depth_age = 0.25;        // s, an older d2 stops the arm
  double min_depth = 0.02;            // m, d2 below it stops the arm
  double max_depth = 0.25;            // m, d2 above it stops the arm
  double max_lateral_offset = 0.015;  // m, from the insertion point to the shaft; beyond it the arm stops
  double max_tip_speed = 0.15;        // m/s, a pose that changes faster was not caused by the arm
  double max_tip_turn = 1.0;          // rad/s, a pose that turns faster was not caused by the arm
  double max_optics_offset = 0.005;   // m, from the shaft's frame to the camera's: both are at the tip
  double resume_time = 2.0;           // s, a hold that ends within it resumes by itself; a longer one disengages
  double max_period = 0.1;            // s, longest step that the limit on acceleration takes into account
  double max_clock_step = 1.0;        // s, a longer pause between two steps is a jump of the clock

  // Visible fractions of the region of interest, 0 to 1.
  double slow_below = 0.5;           // the less is visible, the slower: full speed here, none at hold_below
  double hold_below = 0.2;           // the arm stops
  double release_hold_above = 0.25;  // and goes on from here
  double min_visible_for_insertion = 0.5;
  double max_corner_error_for_insertion = 1.0;  // px, expected error of the worst corner

  bool dead_man_required = false;    // a dead-man switch must be pressed while the arm moves
  double max_dead_man_age = 0.2;     // s, since its last message; a silent switch counts as released
  bool robot_required = true;        // the robot must report that it is enabled
  double max_robot_state_age = 0.3;  // s, since the robot's last report
  double max_manual_age = 0.2;       // s, an older manual command counts as none: the arm stops
  // s, a manual command other than zero that repeats for longer comes from a pad out of reach
  double max_manual_repeat = 5.0;
  double manual_neutral = 0.02;  // share of the limits on velocity up to which a stick counts as released
  // number of task errors in a row that repeat to the last digit while the scope moves, which stops the arm
  int max_repeated_errors = 3;
  double max_clock_difference = 0.1;  // s, by which the clocks of two machines may differ
};

// Adds the rows of all parameters, with range and meaning.
void describe(parameters::Table& table, SafetyConfig& config);

}  // namespace laparoscope_servo::servo
