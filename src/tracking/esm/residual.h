// The residual at an iteration of ESM, gain * image + bias - reference, over the pixels that have a weight.
#pragma once

#include <vector>

#include "tracking/esm/esm_level.h"

namespace laparoscope_servo::tracking {

// Adds one value to the biases of all blocks of a plane so that the plane's mean residual is zero. Returns the mean of
// these values over the planes [grey levels].
double matchMean(EsmLevel& level, double gain);

// Robust standard deviation of the residual, from the median of its magnitudes over about a thousand pixels.
class ResidualScale {
 public:
  // Grey levels, at least 1 (quantisation); 1 if no pixel has a weight.
  double of(const EsmLevel& level, double gain);

 private:
  std::vector<int> histogram_;  // histogram of the magnitudes
};

}  // namespace laparoscope_servo::tracking
