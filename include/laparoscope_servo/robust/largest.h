// Maximum that keeps NaN.
#pragma once

#include <algorithm>
#include <cmath>

namespace laparoscope_servo::robust {

// The larger value; NaN if either is NaN. std::max may drop a NaN, and an invalid value would look like a small one.
inline double largest(double a, double b) {
  return std::isnan(a) ? a : std::isnan(b) ? b : std::max(a, b);
}

}  // namespace laparoscope_servo::robust
