// Parameters of the estimate of the robot's delay.
#pragma once

#include <string>
#include <vector>

#include "laparoscope_servo/scope/velocity.h"

namespace laparoscope_servo::servo {

struct DelayConfig {
  double initial = 0.16;         // s, until something better is known
  double minimum = 0.0;          // s
  double maximum = 0.4;          // s
  double lag = 0.0;              // s, known time constant of the robot, not part of the delay
  double window = 5.0;           // s, of reports that are compared with the commands
  double period = 0.2;           // s, between two comparisons
  double step = 0.01;            // s, between the delays that are tried
  double max_rate = 0.02;        // s/s, the estimate changes no faster
  double max_gap = 0.5;          // s, between commands or reports; a longer one starts anew
  double min_correlation = 0.8;  // of commands and reports, 0 to 1
  double max_stddev = 0.02;      // s, a comparison that is less certain is not used
  scope::Velocity min_excitation{0.01, 0.01, 0.01, 0.001};  // standard deviation of commands; an axis below is left out
};

// Every error, each naming the field, its value and what was expected; empty when there is none.
std::vector<std::string> validate(const DelayConfig& config);

}  // namespace laparoscope_servo::servo
