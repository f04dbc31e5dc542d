#include "servo/shaping/oscillation_guard.h"

#include <algorithm>
#include <cmath>

namespace laparoscope_servo::servo {

void OscillationGuard::reset() {
  swings_.fill(Swing());
  factor_ = 1.0;
}

bool OscillationGuard::swings(Swing& swing, double time, double error, double threshold) const {
  if (!(std::abs(error) > threshold)) return false;
  const int side = error > 0.0 ? 1 : -1;
  if (side == swing.side) return false;
  swing.changes = swing.side != 0 && time - swing.time < config_.half_period ? swing.changes + 1 : 0;
  swing.side = side;
  swing.time = time;
  return swing.changes >= config_.changes;
}

double OscillationGuard::update(double time, const TaskError& error) {
  if (!config_.enabled) return 1.0;
  const double errors[] = {error.x - error.desired_x, error.y - error.desired_y,
                           error.log_depth - error.desired_log_depth,
                           std::remainder(error.alpha - error.desired_alpha, 2.0 * M_PI)};
  const double thresholds[] = {config_.centre, config_.centre, config_.depth, config_.orientation};
  bool swinging = false;
  for (std::size_t k = 0; k < 4; ++k) swinging |= swings(swings_[k], time, errors[k], thresholds[k]);
  if (!swinging) return factor_;
  for (Swing& swing : swings_) swing.changes = 0;  // later changes are counted with the new gain
  factor_ = std::max(config_.least, config_.step * factor_);
  return factor_;
}

}  // namespace laparoscope_servo::servo
