// The largest of values that may be no numbers.
#pragma once

#include <algorithm>
#include <cmath>

namespace laparoscope_servo::robust {

// NaN when one of both is: std::max drops it, and what was wrong would look like a small number.
inline double largest(double a, double b) {
  return std::isnan(a) ? a : std::isnan(b) ? b : std::max(a, b);
}

}  // namespace laparoscope_servo::robust
