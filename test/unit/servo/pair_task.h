// The tasks of fault_pairs_test.cpp: what the controller is told in each, of what is seen of the region.
#pragma once

#include <limits>

#include "laparoscope_servo/servo/controller.h"
#include "laparoscope_servo/servo/place_error.h"

namespace laparoscope_servo::servo {

struct PairTask {
  const char* name;
  Task task;
  double until_moving;  // s, from 0.4 s after it was engaged
  double there;         // px, of the region's middle from its place: the task is done
  int runs;             // of the test suite

  // The region's middle is that of an object or a tip; the region's task error is that of points, of a view, or by
  // 2 1/2 D. A number that is none, in whatever the region has and a place does not have, becomes one of the place.
  void tell(ControllerInput& input) const {
    if (task == Task::kHoldView || task == Task::kManual) return;
    TaskErrorInput seen = input.task_error;
    input.task_error = TaskErrorInput();
    if (task == Task::kFollow || task == Task::kCentreTip) {
      const TaskError& error = seen.error;
      const double x = isFinite(error) ? error.x : std::numeric_limits<double>::quiet_NaN();
      seen.error = placeError({x, error.y}, {error.desired_x, error.desired_y});
    }
    input.seenBy(task) = seen;
  }
};

const PairTask kManualPairs{"MANUAL", Task::kManual, 0.0, 3.0, 0};

// A tip has to be held still for half a second first, and rests within the zone, 60 px.
const PairTask kPairTasks[] = {
    {"HOLD_VIEW", Task::kHoldView, 0.0, 3.0, 1000}, {"FOLLOW", Task::kFollow, 0.0, 3.0, 1000},
    {"STABILISE", Task::kStabilise, 0.0, 3.0, 100}, {"POINTS", Task::kPoints, 0.0, 3.0, 100},
    {"POSITION", Task::kPosition, 0.0, 3.0, 100},   {"CENTRE_TIP", Task::kCentreTip, 1.0, 61.0, 60},
};

}  // namespace laparoscope_servo::servo
