#include "servo/shaping/hysteresis_band.h"

#include <algorithm>
#include <cmath>

namespace laparoscope_servo::servo {

bool HysteresisBand::update(Band& band, double distance, double stop, double start, double time) const {
  constexpr double kFar = 5.0;  // times `start`: a larger error is a new target, not hunting
  if (distance > kFar * start) band.widened = 1.0;
  // NaN counts as off, so that an invalid error is not taken for rest.
  const bool moves = !(distance < (band.moves ? stop : band.widened * start));
  if (moves && !band.moves && time - band.stopped < config_.hunting_time) {
    band.widened = std::min(config_.widest, config_.widening * band.widened);
  }
  if (!moves && band.moves) band.stopped = time;
  band.moves = moves;
  return moves;
}

TaskError HysteresisBand::apply(const TaskError& error, double time) {
  if (!config_.enabled) return error;
  const RestConfig& c = config_;
  const double centre = std::hypot(error.x - error.desired_x, error.y - error.desired_y);
  const double depth = std::abs(error.log_depth - error.desired_log_depth);
  const double orientation = std::abs(std::remainder(error.alpha - error.desired_alpha, 2.0 * M_PI));
  TaskError result = error;
  if (!update(centre_, centre, c.centre_stop, c.centre_start, time)) {
    result.x = error.desired_x;
    result.y = error.desired_y;
    result.e_v.head<2>().setZero();
  }
  if (!update(depth_, depth, c.depth_stop, c.depth_start, time)) {
    result.log_depth = error.desired_log_depth;
    result.e_v.z() = 0.0;
  }
  if (!update(orientation_, orientation, c.orientation_stop, c.orientation_start, time)) {
    result.alpha = error.desired_alpha;
    result.e_w.setZero();
  }
  return result;
}

}  // namespace laparoscope_servo::servo
