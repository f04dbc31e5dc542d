// Parameters of the estimate of the insertion point.
#pragma once

#include <string>
#include <vector>

namespace laparoscope_servo::parameters {
class Table;
}

namespace laparoscope_servo::servo {

struct InsertionPointConfig {
  double position_noise = 0.0005;    // m, of a pose, standard deviation per axis
  double direction_noise = 0.0035;   // rad, of a shaft's direction, standard deviation per axis
  double wobble = 0.001;             // m, what breathing moves the point by about its mean, standard deviation
  double drift = 0.0001;             // m/sqrt(s), random walk of the mean; 0: it stands still
  double same_direction = 0.009;     // rad, shafts closer than this are about the same observation
  int samples_per_direction = 20;    // as many of the same direction count; a new one replaces the oldest of them
  int max_samples = 400;             // kept in all
  int min_samples = 10;              // fewer do not make an estimate of their own
  double min_eigenvalue = 0.005;     // of the mean of I - aa', 0 to 2/3: below it, nothing was seen along the shaft
  int residual_samples = 25;         // the last ones, of which the residual is taken
  double warning_residual = 0.006;   // m, a warning from it on
  double stop_residual = 0.012;      // m, a stop from it on
  double residual_hysteresis = 0.2;  // a level ends when the residual is below (1 - this) times its threshold
};

// Rows for all of it: ranges and meanings.
void describe(parameters::Table& table, InsertionPointConfig& config);

// Every error, each naming the field, its value and what was expected; empty when there is none.
std::vector<std::string> validate(const InsertionPointConfig& config);

}  // namespace laparoscope_servo::servo
