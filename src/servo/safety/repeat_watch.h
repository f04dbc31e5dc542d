// Detects task errors of a repeating picture: while the scope moves, and with the noise of real pictures, no two task
// errors are equal to the last digit.
//
// The tracker checks the pictures themselves (image::RepeatWatch); this check works for any source of task errors.
#pragma once

#include <optional>

#include "laparoscope_servo/servo/task_function.h"

namespace laparoscope_servo::servo {

class RepeatWatch {
 public:
  // `most`: number of repetitions in a row, while the scope moves, that count as a repeated picture.
  explicit RepeatWatch(int most) : most_(most) {}

  // Takes the valid task error of an image taken at `image_time` [s]; a call with the last time is ignored, since it is
  // the same message. `moves`: the scope's motion must be visible in the image.
  void take(double image_time, const TaskError& error, bool moves);

  // Latched until a different error arrives: stopping the scope must not clear the condition.
  bool repeats() const { return repeats_; }

 private:
  int most_;
  int count_ = 0;
  bool repeats_ = false;
  double image_time_ = 0.0;
  std::optional<TaskError> last_;
};

}  // namespace laparoscope_servo::servo
