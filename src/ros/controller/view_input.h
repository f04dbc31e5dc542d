// The task error of the whole view, from what the nodelet DominantMotion says: the input of the tasks STABILISE and
// PARALLEL.
#pragma once

#include <laparoscope_servo/TrackedFeatures.h>

#include "laparoscope_servo/servo/task_error_input.h"
#include "ros/controller/feature_camera.h"

namespace laparoscope_servo {

// Of servo::viewRegion(), from the anchor image, on which the features were selected, to the image of the message. Not
// valid unless the motion is TRACKING; `problem` says what is wrong with the message or the camera. The caller fills in
// the ages.
servo::TaskErrorInput viewInput(const TrackedFeatures& message, const FeatureCamera& camera);

}  // namespace laparoscope_servo
