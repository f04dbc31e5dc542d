// Assignment of a joystick's axes and buttons.
#pragma once

#include <string>
#include <vector>

#include "laparoscope_servo/parameters/table.h"

namespace laparoscope_servo {

// Numbers of axes and buttons as `jstest` shows them; -1: none. The defaults are those of the kernel's driver xpad.
struct StickConfig {
  struct Axis {
    int axis = -1;
    bool reversed = false;
    double velocity = 0.0;  // rad/s or m/s, at full deflection
  };
  Axis pan{0, false, 0.1};
  Axis tilt{1, true, 0.1};
  Axis spin{3, false, 0.1};
  Axis insertion{4, true, 0.02};
  double neutral = 0.1;         // share of the full deflection below which it counts as neutral
  int dead_man_button = 5;      // while held, the scope may move
  int pedal_button = -1;        // button of a pedal with the same function
  int pedal_axis = -1;          // axis of a pedal with the same function
  bool pedal_reversed = false;  // the pedal's axis is at its upper end when it is not pressed
  double pedal_pressed = 0.75;  // share of its travel from which the pedal counts as pressed
  bool only_while_held = true;  // the stick publishes only while button or pedal is held
  double max_silence = 5.0;     // s: a deflection or a hold without any event for longer means out of radio range
};

void describe(parameters::Table& table, StickConfig& config);
std::vector<std::string> validate(const StickConfig& config);

}  // namespace laparoscope_servo
