// What the controller sees by its present task, and what is wrong with it.
#include <cmath>

#include "servo/controller_implementation.h"

namespace laparoscope_servo::servo {

// What the present task goes by; in MANUAL nothing is.
const TaskErrorInput& Controller::Implementation::seen(const ControllerInput& input) const {
  if (task_ == Task::kStabilise) return input.view;
  return task_ == Task::kCentreTip ? input.tip : input.task_error;
}

std::string Controller::Implementation::problemOf(const TaskErrorInput& seen) const {
  const std::string impossible = implausible(seen);
  if (!impossible.empty()) return impossible;
  if (task_ == Task::kStabilise && !(seen.corner_error <= config_.stabilise.max_error))
    return "where the view is, is not known well enough: its expected error is above stabilise/max_error";
  if (task_ == Task::kCentreTip) {
    const CentreTipConfig& c = config_.centre_tip;
    if (!(seen.corner_error <= c.max_error))
      return "where the tip is, is not known well enough: its expected error is above centre_tip/max_error";
    if (!(std::hypot(seen.error.x - c.x, seen.error.y - c.y) <= c.leave))
      return "the tip leaves: it is further from the zone's middle than centre_tip/leave";
  }
  if (repeats_.repeats())
    return "the picture repeats: the task error stays the same to the last digit while the scope moves";
  return "";
}

void Controller::Implementation::watchTip(const TaskErrorInput& tip) {
  if (task_ != Task::kCentreTip || !told_.isZero(0.0) || !tip.problem.empty() || !tip.valid || !tip.image_time) {
    tip_.restart();
  } else {
    tip_.see(*tip.image_time, {tip.error.x, tip.error.y});
  }
}

}  // namespace laparoscope_servo::servo
