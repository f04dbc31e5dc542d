// The task error of a single place in the image, for the tasks CENTRE_TIP and FOLLOW.
#pragma once

#include <Eigen/Core>

#include "laparoscope_servo/servo/task_function.h"

namespace laparoscope_servo::servo {

// Of what is seen at `place` and shall be seen at `desired`, both normalised. A place has neither depth nor
// orientation: it is taken to be as far as the tissue at the reference, and e_v, e_w are zero.
TaskError placeError(const Eigen::Vector2d& place, const Eigen::Vector2d& desired);

}  // namespace laparoscope_servo::servo
