#include "servo/safety/manual_stick.h"

#include <cmath>
#include <sstream>

namespace laparoscope_servo::servo {

std::string ManualStick::update(const ManualInput& input, bool drives, double time) {
  if (input.velocity.vector() != last_.vector()) {  // NaN always differs
    last_ = input.velocity;
    since_ = time;
  }
  if (!drives) seen_at_rest_ = false;
  if (!drives) return "";
  const std::string problem = unusable(input, time);
  if (!problem.empty()) {
    seen_at_rest_ = false;
    return problem;
  }
  seen_at_rest_ = seen_at_rest_ || deflection(input.velocity).vector().isZero(0.0);
  return seen_at_rest_ ? "" : "stands: release the stick once";
}

std::string ManualStick::unusable(const ManualInput& input, double time) const {
  std::ostringstream text;
  if (!(input.age >= 0.0 && input.age <= config_.max_manual_age)) {
    text << "stands: no manual command for " << config_.max_manual_age << " s";
  } else if (!input.velocity.vector().allFinite()) {
    text << "stands: the manual command is not finite";
  } else if (!deflection(input.velocity).vector().isZero(0.0) && !(time - since_ <= config_.max_manual_repeat)) {
    text << "stands: the manual command is the same to the last digit for " << config_.max_manual_repeat
         << " s, as of a pad out of reach; move the stick, and release it once";
  }
  return text.str();
}

scope::Velocity ManualStick::deflection(const scope::Velocity& velocity) const {
  Eigen::Vector4d deflected = velocity.vector();
  for (int k = 0; k < 4; ++k) {
    if (std::abs(deflected[k]) <= config_.manual_neutral * full_.vector()[k]) deflected[k] = 0.0;
  }
  return scope::Velocity::fromVector(deflected);
}

}  // namespace laparoscope_servo::servo
