// What the controller is told of the image: a task error, and how much of it can be believed.
#pragma once

#include <limits>
#include <optional>
#include <string>

#include "laparoscope_servo/servo/task_function.h"

namespace laparoscope_servo::servo {

struct TaskErrorInput {
  std::string problem = "no task error was received";  // why there is none that could be used; empty: there is
  bool valid = false;                                  // the tracker's own word
  double region = 0.0;                                 // another number is another region of interest
  TaskError error;
  double age = std::numeric_limits<double>::infinity();        // s, since the message came
  double image_age = std::numeric_limits<double>::infinity();  // s, since the image was taken
  std::optional<double> image_time;  // s, when that was, on the clock of ControllerInput::time
  double visible_fraction = 0.0;     // 0 to 1, of the region of interest
  double corner_error = std::numeric_limits<double>::infinity();  // px, expected of the worst corner
};

// Which of its numbers no tracker of a region in the image can say, in words that stay the same while it is so; empty
// when all are possible. Only of a task error that is valid: of another one nothing counts.
std::string implausible(const TaskErrorInput& input);

}  // namespace laparoscope_servo::servo
