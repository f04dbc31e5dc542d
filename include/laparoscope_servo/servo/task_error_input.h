// The controller's input from the tracker: a task error and its quality.
#pragma once

#include <limits>
#include <optional>
#include <string>

#include "laparoscope_servo/servo/task_function.h"
#include "laparoscope_servo/servo/view_motion.h"

namespace laparoscope_servo::servo {

struct TaskErrorInput {
  std::string problem = "no task error was received";  // why there is no usable task error; empty: there is one
  bool valid = false;                                  // `valid` field of the message
  // identifies the region of interest; changes when another one is selected
  double region = 0.0;
  TaskError error;
  double age = std::numeric_limits<double>::infinity();        // s, since the message came
  double image_age = std::numeric_limits<double>::infinity();  // s, since the image was taken
  std::optional<double> image_time;  // s, time of the image on the clock of ControllerInput::time
  double visible_fraction = 0.0;     // 0 to 1, visible share of the region of interest
  double corner_error = std::numeric_limits<double>::infinity();  // px, expected error of the worst corner
  std::optional<ViewMotion> motion;  // of the view, whose task error this is; empty: of something else
};

// Which value is impossible for a region in the image, in a text that does not change while it is so; empty if all are
// possible. Call for valid task errors only: the values of others have no meaning.
std::string implausible(const TaskErrorInput& input);

}  // namespace laparoscope_servo::servo
