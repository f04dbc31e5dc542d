// Which axes and buttons of a joystick mean what.
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
  double neutral = 0.1;         // share of the way, from where on a deflection counts
  int dead_man_button = 5;      // held: the scope may move
  int pedal_button = -1;        // of a pedal that is a button: does the same
  int pedal_axis = -1;          // of a pedal that is an axis: does the same
  bool pedal_reversed = false;  // it is at its upper end when nobody treads on it
  double pedal_pressed = 0.75;  // share of its way from which on the pedal is trodden on
  bool only_while_held = true;  // the stick speaks only while button or pedal is held
  double max_silence = 5.0;     // s, a deflection or a hold without any event for longer: out of reach
};

void describe(parameters::Table& table, StickConfig& config);
std::vector<std::string> validate(const StickConfig& config);

}  // namespace laparoscope_servo
