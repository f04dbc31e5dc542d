// Tells task errors of a picture that repeats from those of a camera that sees: while the scope moves, and through the
// noise of every picture, no two task errors are the same to the last digit.
//
// The tracker looks at the pictures themselves; this holds for any source of task errors.
#pragma once

#include <optional>

#include "laparoscope_servo/servo/task_function.h"

namespace laparoscope_servo::servo {

class RepeatWatch {
 public:
  // `most`: as many repetitions in a row, while the scope moves, are a repeated picture.
  explicit RepeatWatch(int most) : most_(most) {}

  // The valid task error of an image taken at `image_time` [s]; the same time again is the same message, which says
  // nothing. `moves`: the scope's motion must have shown in it.
  void take(double image_time, const TaskError& error, bool moves);

  // Holds until another task error comes: a scope that stands because of it must not take its standing for an excuse.
  bool repeats() const { return repeats_; }

 private:
  int most_;
  int count_ = 0;
  bool repeats_ = false;
  double image_time_ = 0.0;
  std::optional<TaskError> last_;
};

}  // namespace laparoscope_servo::servo
