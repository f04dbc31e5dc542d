// Pictures and axes that are not what they should be, of which each must stop every task.
#pragma once

#include <cmath>

#include "laparoscope_servo/closed_loop/servo_simulation.h"

namespace laparoscope_servo::closed_loop {

struct Fault {
  const char* name;
  void (*apply)(SimulationConfig&);
};

inline constexpr Fault kWrongPictures[] = {
    {"mirrored, left for right", [](SimulationConfig& c) { c.picture.mirror = "left_right"; }},
    {"mirrored, up for down", [](SimulationConfig& c) { c.picture.mirror = "up_down"; }},
    {"rolled by 90 degrees", [](SimulationConfig& c) { c.picture.roll = 0.5 * M_PI; }},
    {"rolled by 180 degrees", [](SimulationConfig& c) { c.picture.roll = M_PI; }},
    {"frozen from the beginning", [](SimulationConfig& c) { c.picture.frozen_from = 0.0; }},
    {"pan reversed", [](SimulationConfig& c) { c.signs[0] = -1.0; }},
    {"tilt reversed", [](SimulationConfig& c) { c.signs[1] = -1.0; }},
};

}  // namespace laparoscope_servo::closed_loop
