// Parameters of the leash, with the defaults that config/controller.yaml repeats. doc/effect.md says how they were
// measured.
#pragma once

namespace laparoscope_servo::parameters {
class Table;
}

namespace laparoscope_servo::servo {

struct LeashConfig {
  bool enabled = true;
  // How far the place from which the region is seen as it has to be may wander from where the view was reached:
  double turn = 0.15;              // rad, pan and tilt together
  double spin = 0.1;               // rad
  double insertion = 0.012;        // m
  double quick_insertion = 0.006;  // m, from its mean over the last `quick_time`
  double quick_time = 2.0;         // s, time constant of that mean
  // Share of what is left to go, by which wrong depths may shift the place: the leash is at least as long on the way,
  // along the shaft longer by that.
  double approach = 1.0;
};

// Adds the rows of all parameters, with range and meaning.
void describe(parameters::Table& table, LeashConfig& config);

}  // namespace laparoscope_servo::servo
