// Detects oscillations of the loop, and lowers its gain.
//
// With a wrong delay or depth the loop may oscillate about the target with a period of a few delays; tissue does not,
// since a breath is slower: half of the fastest one that is followed, 0.5 Hz, takes 1 s. If feature errors change their
// sign quickly, several times in a row and by more than noise, the gain is lowered by a step, until the loop starts
// anew. A loop whose pictures are 0.2 s older than their stamps needs 0.75 to 0.95 s from one change to the next
// (measured with test/unit/servo/late_picture_test.cpp).
#pragma once

#include <array>

#include "laparoscope_servo/servo/shaping_config.h"
#include "laparoscope_servo/servo/task_function.h"

namespace laparoscope_servo::servo {

class OscillationGuard {
 public:
  explicit OscillationGuard(const OscillationConfig& config) : config_(config) {}

  // Takes the errors in an image taken at `time` [s]; returns the factor for the gains, from `least` to 1.
  double update(double time, const TaskError& error);

  double factor() const { return factor_; }
  void reset();

 private:
  struct Swing {
    int side = 0;       // side on which it last was beyond the threshold
    double time = 0.0;  // s, when it reached that side
    int changes = 0;    // in a row
  };
  bool swings(Swing& swing, double time, double error, double threshold) const;

  OscillationConfig config_;
  std::array<Swing, 4> swings_{};
  double factor_ = 1.0;
};

}  // namespace laparoscope_servo::servo
