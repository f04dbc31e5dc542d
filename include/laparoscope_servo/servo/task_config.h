// Parameters of the tasks, with the defaults that config/controller.yaml repeats.
#pragma once

namespace laparoscope_servo::parameters {
class Table;
}

namespace laparoscope_servo::servo {

// The task STABILISE.
struct StabiliseConfig {
  bool spin = false;       // the scope's spin is used, as the parameter `spin` says; false: it does not spin
  bool insertion = false;  // the distance to the tissue is kept by insertion; false: it does not move along the shaft
  double max_error = 2.0;  // px, expected error of the view at its worst corner, beyond which the scope stands
};

// Adds the rows of all parameters, with range and meaning.
void describe(parameters::Table& table, StabiliseConfig& config);

}  // namespace laparoscope_servo::servo
