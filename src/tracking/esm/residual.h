// What is left between reference and image at an iteration of ESM: gain * image + bias - reference, where pixels have a
// weight.
#pragma once

#include <vector>

#include "tracking/esm/esm_level.h"

namespace laparoscope_servo::tracking {

// Adds one bias to those of all of a plane's blocks, which leaves no mean residual. Returns it, the mean of the planes'
// [grey levels].
double matchMean(EsmLevel& level, double gain);

// The residual's robust standard deviation, by the median of its magnitudes over about a thousand pixels.
class ResidualScale {
 public:
  // Grey levels, never below that of quantisation; that, too, where no pixel has a weight.
  double of(const EsmLevel& level, double gain);

 private:
  std::vector<int> histogram_;  // of the magnitudes
};

}  // namespace laparoscope_servo::tracking
