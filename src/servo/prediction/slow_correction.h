// A correction that is taken over slowly: an estimate that jumps does not make the scope jump.
#pragma once

#include <algorithm>
#include <cmath>

namespace laparoscope_servo::servo {

class SlowCorrection {
 public:
  // `rate` >= 0: the most that it changes in a second.
  explicit SlowCorrection(double rate) : rate_(rate) {}

  // One that is not finite is none. Time that does not increase changes nothing yet, and of a clock that jumped ahead
  // no more than a second counts.
  void update(double time, double wanted) {
    wanted_ = std::isfinite(wanted) ? wanted : 0.0;
    const double step = has_time_ && time > time_ ? rate_ * std::min(time - time_, kLongestStep) : 0.0;
    value_ += std::clamp(wanted_ - value_, -step, step);
    time_ = time;
    has_time_ = true;
  }

  double value() const { return value_; }
  double wanted() const { return wanted_; }

 private:
  static constexpr double kLongestStep = 1.0;  // s, the default of safety/max_clock_step: a longer one ends the motion
  double rate_;
  double value_ = 0.0;
  double wanted_ = 0.0;
  bool has_time_ = false;
  double time_ = 0.0;  // s, of the last update
};

}  // namespace laparoscope_servo::servo
