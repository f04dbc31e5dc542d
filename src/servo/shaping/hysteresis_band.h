// The bands about the target within which the scope rests.
//
// A feature that is at rest starts to be servoed when it is off by at least `start`, and is left alone again when it is
// off by less than `stop`. Without the bands the noise of the images would keep the arm moving, and through the inverse
// of the dead zone by no small steps. A feature that starts again soon after it stopped is being hunted - the robot's
// dead zone is not what the inverse takes it for -, and its band grows until it rests.
#pragma once

#include "laparoscope_servo/servo/shaping_config.h"
#include "laparoscope_servo/servo/task_function.h"

namespace laparoscope_servo::servo {

class HysteresisBand {
 public:
  explicit HysteresisBand(const RestConfig& config) : config_(config) {}

  // The error at `time` [s] with the features that rest at their desired values, for any law. Remembers which rest. A
  // feature that is not finite stays as it is.
  TaskError apply(const TaskError& error, double time);

  // Other bands: what rests in them, and how they are widened, stays.
  void retune(const RestConfig& config) { config_ = config; }

  // Every feature is at rest, and the bands are as configured.
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
