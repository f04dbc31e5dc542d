// How far apart two quadrilaterals are.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace laparoscope_servo {

// px, of the corner that lies farthest from its like; NaN when one is nowhere. Both u0 v0 u1 v1 u2 v2 u3 v3, as in
// Homography.msg.
template <class Corners, class OtherCorners>
double cornersApart(const Corners& a, const OtherCorners& b) {
  double most = 0.0;
  for (std::size_t k = 0; k < 8; k += 2) {
    const double apart = std::hypot(a[k] - b[k], a[k + 1] - b[k + 1]);
    if (std::isnan(apart)) return apart;
    most = std::max(most, apart);
  }
  return most;
}

}  // namespace laparoscope_servo
