// A controller in a task that goes by what one source sees, in the closed loop's stead: what is seen stays where it is,
// whatever the scope does.
#pragma once

#include "controller_input.h"
#include "laparoscope_servo/servo/place_error.h"

namespace laparoscope_servo::servo::test {

class WatchingTask {
 public:
  static constexpr double kPeriod = 0.02;  // s

  // Seen at `place`, normalised; nothing else is said of the picture. The task is not selected yet.
  WatchingTask(Task chosen, const Eigen::Vector2d& place, const ControllerConfig& configuration = blind())
      : config(configuration), controller(config), task(chosen), input(good(0.0)) {
    const TaskErrorInput told = input.task_error;
    input.task_error = TaskErrorInput();
    seen() = told;
    seen().region = 1.0;
    seen().image_time = -kImageAge;
    seeAt(place);
  }
  void engage() {
    controller.select(task);
    ASSERT_EQ(controller.engage(input), "");
  }
  TaskErrorInput& seen() { return input.seenBy(task); }
  void seeAt(const Eigen::Vector2d& place) { seen().error = placeError(place, {0.0, 0.0}); }
  ControllerOutput step() {
    time += kPeriod;
    input.time = time;
    if (seen().image_time) seen().image_time = time - kImageAge;
    seen().error.x += 1e-9;  // no two pictures are the same
    return last = controller.update(input);
  }

  ControllerConfig config;
  Controller controller;
  Task task;
  ControllerInput input;
  ControllerOutput last;
  double time = 0.0;

 private:
  static constexpr double kImageAge = 0.05;  // s
};

}  // namespace laparoscope_servo::servo::test
