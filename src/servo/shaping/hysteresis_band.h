// The bands about the target within which the scope rests.
//
// A feature at rest is servoed when its error reaches `start`, and rests again when the error is below `stop`. Without
// the bands the noise of the images would keep the arm moving, in large steps because of the inverse of the dead zone.
// A feature that starts again soon after it stopped indicates hunting (a limit cycle: the robot's dead zone differs
// from the configured one); its band is then widened until it rests.
#pragma once

#include "laparoscope_servo/servo/shaping_config.h"
#include "laparoscope_servo/servo/task_function.h"

namespace laparoscope_servo::servo {

class HysteresisBand {
 public:
  explicit HysteresisBand(const RestConfig& config) : config_(config) {}

  // Returns the error at `time` [s] with all resting features set to their desired values, for any law. Keeps which
  // features rest. A non-finite feature is not changed.
  TaskError apply(const TaskError& error, double time);

  // Sets other bands; which features rest and how far bands are widened does not change.
  void retune(const RestConfig& config) { config_ = config; }

  // All features are at rest, and no band is widened.
  void reset() { centre_ = depth_ = orientation_ = Band(); }

 private:
  struct Band {
    bool moves = false;  // is servoed
    double widened = 1.0;
    double stopped = -1e9;  // s
  };
  bool update(Band& band, double distance, double stop, double start, double time) const;

  RestConfig config_;
  Band centre_, depth_, orientation_;
};

}  // namespace laparoscope_servo::servo
