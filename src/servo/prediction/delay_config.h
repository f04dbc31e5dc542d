// Parameters of the estimate of the robot's delay.
#pragma once

#include <string>
#include <vector>

#include "laparoscope_servo/scope/velocity.h"

namespace laparoscope_servo::servo {

struct DelayConfig {
  double initial = 0.16;   // s, until the delay is measured
  double minimum = 0.0;    // s
  double maximum = 0.4;    // s
  double lag = 0.0;        // s, known time constant of the robot, not part of the delay
  double window = 5.0;     // s, length of the window of reports that are compared with the commands
  double period = 0.2;     // s, between two comparisons
  double step = 0.01;      // s, step between the delays that are tried
  double max_rate = 0.02;  // s/s, largest rate of change of the estimate
  // s, largest gap between commands or reports; after a longer one the window starts anew
  double max_gap = 0.5;
  double min_correlation = 0.8;  // least correlation of commands and reports, 0 to 1
  double max_stddev = 0.02;      // s, largest standard deviation of a comparison that is used
  // least standard deviation of commands for an axis to be used
  scope::Velocity min_excitation{0.01, 0.01, 0.01, 0.001};
};

// Every error, each naming the field, its value and what was expected; empty when there is none.
std::vector<std::string> validate(const DelayConfig& config);

}  // namespace laparoscope_servo::servo
