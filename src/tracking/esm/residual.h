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

  // Of the pixels that of() looked at last, those that Tukey's weights keep at the scale `sigma`: their scale, at least
  // 1 grey level. Repeated, it leaves out what lies apart, where that is less than half of them.
  double ofKept(double sigma) const;
  // Mean of Tukey's rho over them at the scale `sigma`, 0 where all residuals are 0 to 1 where none is kept; and their
  // number.
  double cost(double sigma) const;
  int count() const { return count_; }

 private:
  std::vector<int> histogram_;  // histogram of the magnitudes
  int count_ = 0;               // in the histogram
};

}  // namespace laparoscope_servo::tracking
