#include "servo/shaping/slew_limiter.h"

#include <algorithm>
#include <cmath>

namespace laparoscope_servo::servo {

namespace {

// The largest factor, from 0 to 1, for which base + factor * v stays within the limits; `base` is within them. A limit
// that is NaN allows nothing; a v that is NaN stays so.
double scaleWithin(const Eigen::Vector4d& v, const Eigen::Vector4d& limit,
                   const Eigen::Vector4d& base = Eigen::Vector4d::Zero()) {
  double scale = 1.0;
  for (int k = 0; k < 4; ++k) {
    if (!(std::abs(base[k] + v[k]) <= limit[k])) {
      scale = std::min(scale, std::max(0.0, limit[k] - std::copysign(1.0, v[k]) * base[k]) / std::abs(v[k]));
    }
  }
  return scale;
}

}  // namespace

scope::Velocity SlewLimiter::apply(std::initializer_list<scope::Velocity> parts, double dt, double room) {
  const Eigen::Vector4d limit = room * limits_.velocity.vector();
  Eigen::Vector4d sum = Eigen::Vector4d::Zero();
  for (const scope::Velocity& part : parts) sum += part.vector();
  const double common = scaleWithin(sum, limit);
  Eigen::Vector4d target = common * sum;
  for (const scope::Velocity& part : parts) {
    if (common < 1.0)
      target += scaleWithin((1.0 - common) * part.vector(), limit, target) * (1.0 - common) * part.vector();
    // removes rounding errors; keeps NaN
    for (int k = 0; k < 4; ++k) target[k] = std::clamp(target[k], -limit[k], limit[k]);
  }
  const Eigen::Vector4d change = target - last_.vector();
  const double scale = scaleWithin(change, dt * limits_.acceleration.vector());
  // If nothing is slowed down, the target is used directly, since last + (target - last) may not be exactly zero.
  last_ = scope::Velocity::fromVector(scale < 1.0 ? Eigen::Vector4d(last_.vector() + scale * change) : target);
  return last_;
}

}  // namespace laparoscope_servo::servo
