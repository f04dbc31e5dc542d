// Notices that the loop swings, and takes its gain back.
//
// What is believed of delay and depths sets how fast the loop may be; where it is wrong, the loop swings about the
// target with a period of a few delays, which no tissue does by itself: a breath is slower. Feature errors that change
// their sign quickly, several times in a row and by more than noise, lower the gain by a step. It stays lowered until
// the loop starts anew.
#pragma once

#include <array>

#include "laparoscope_servo/servo/shaping_config.h"
#include "laparoscope_servo/servo/task_function.h"

namespace laparoscope_servo::servo {

class OscillationGuard {
 public:
  explicit OscillationGuard(const OscillationConfig& config) : config_(config) {}

  // The errors in an image taken at `time` [s]; the factor for the gains, from `least` to 1.
  double update(double time, const TaskError& error);

  double factor() const { return factor_; }
  void reset();

 private:
  struct Swing {
    int side = 0;       // on which it was last, beyond the threshold
    double time = 0.0;  // s, when it got there
    int changes = 0;    // in a row
  };
  bool swings(Swing& swing, double time, double error, double threshold) const;

  OscillationConfig config_;
  std::array<Swing, 4> swings_{};
  double factor_ = 1.0;
};

}  // namespace laparoscope_servo::servo
