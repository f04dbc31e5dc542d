// Parameters of the estimate of the insertion point.
#pragma once

#include <string>
#include <vector>

namespace laparoscope_servo::parameters {
class Table;
}

namespace laparoscope_servo::servo {

struct InsertionPointConfig {
  double position_noise = 0.0005;   // m, of a pose, standard deviation per axis
  double direction_noise = 0.0035;  // rad, of a shaft's direction, standard deviation per axis
  double wobble = 0.001;            // m, standard deviation of the point's motion with breathing, about its mean
  double drift = 0.0001;            // m/sqrt(s), random walk of the mean; 0: fixed
  double same_direction = 0.009;    // rad, shafts whose directions differ by less count as one observation
  int samples_per_direction = 20;   // poses kept for a direction; a new one replaces the oldest
  int max_samples = 400;            // poses kept in all
  int min_samples = 10;             // with fewer poses there is no estimate apart from the prior
  // of the mean of I - aa', 0 to 2/3: below it, the place along the shaft is not observable
  double min_eigenvalue = 0.005;
  int residual_samples = 25;         // number of last poses over which the residual is computed
  double warning_residual = 0.006;   // m, threshold of a warning
  double stop_residual = 0.012;      // m, threshold of a stop
  double residual_hysteresis = 0.2;  // a level ends when the residual is below (1 - this) times its threshold
};

// Adds the rows of all parameters, with range and meaning.
void describe(parameters::Table& table, InsertionPointConfig& config);

// Every error, each naming the field, its value and what was expected; empty when there is none.
std::vector<std::string> validate(const InsertionPointConfig& config);

}  // namespace laparoscope_servo::servo
