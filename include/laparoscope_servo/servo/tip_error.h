// The task error of an instrument's tip, for the task CENTRE_TIP.
#pragma once

#include <Eigen/Core>

#include "laparoscope_servo/servo/task_config.h"
#include "laparoscope_servo/servo/task_function.h"

namespace laparoscope_servo::servo {

// Of a tip that is seen at `tip` (normalised), from the zone's middle. A point has neither depth nor orientation: it
// is taken to be as far as the tissue at the reference, and e_v, e_w are zero.
TaskError tipError(const Eigen::Vector2d& tip, const CentreTipConfig& config);

}  // namespace laparoscope_servo::servo
