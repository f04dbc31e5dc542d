// Weights of robust estimation, w(u) = psi(u) / u, eq. (11) of Marchand and Chaumette (2004), of a residual u in
// standard deviations, either sign. 1 at u = 0; NaN for NaN.
#pragma once

#include <cmath>

#include "laparoscope_servo/robust/scale.h"

namespace laparoscope_servo::robust {

// Eq. (12), divided by C^4, which the survey leaves out, so that weights end at 1: (1 - (u / C)^2)^2, 0 from |u| = C.
inline double tukeyWeight(double u) {
  const double t = u / kTukey;
  const double left = 1.0 - t * t;
  return left < 0.0 ? 0.0 : left * left;
}

// Never 0: what lies far off pulls as hard as what lies at kHuber.
inline double huberWeight(double u) {
  const double magnitude = std::abs(u);
  return magnitude > kHuber ? kHuber / magnitude : 1.0 + 0.0 * magnitude;
}

}  // namespace laparoscope_servo::robust
