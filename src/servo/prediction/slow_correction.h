// A correction whose rate is limited, so that a jump of an estimate does not make the scope jump.
#pragma once

#include <algorithm>
#include <cmath>

namespace laparoscope_servo::servo {

class SlowCorrection {
 public:
  // `rate` >= 0: largest change per second.
  explicit SlowCorrection(double rate) : rate_(rate) {}

  // A non-finite `wanted` counts as zero. Nothing changes if time does not increase; a longer step counts as one
  // second.
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
