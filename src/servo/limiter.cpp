#include "laparoscope_servo/servo/limiter.h"

#include <algorithm>
#include <cmath>

namespace laparoscope_servo::servo {

namespace {

// The largest factor, at most 1, that brings every component of `v` within its limit.
double scaleWithin(const Eigen::Vector4d& v, const Eigen::Vector4d& limit) {
  double scale = 1.0;
  for (int k = 0; k < 4; ++k) {
    if (std::abs(v[k]) > limit[k]) scale = std::min(scale, limit[k] / std::abs(v[k]));
  }
  return scale;
}

}  // namespace

ScopeVelocity Limiter::apply(const ScopeVelocity& wanted, double dt) {
  const Eigen::Vector4d target = scaleWithin(wanted.vector(), limits_.velocity.vector()) * wanted.vector();
  const Eigen::Vector4d change = target - last_.vector();
  const double scale = scaleWithin(change, dt * limits_.acceleration.vector());
  // With nothing to slow down the target is taken as it is: last + (target - last) would leave rounding where a zero is
  // meant.
  last_ = ScopeVelocity::fromVector(scale < 1.0 ? Eigen::Vector4d(last_.vector() + scale * change) : target);
  return last_;
}

}  // namespace laparoscope_servo::servo
