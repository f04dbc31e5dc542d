// The task error of a moving object, from what the nodelet DominantMotion says of a region: the input of the task
// FOLLOW.
#pragma once

#include <laparoscope_servo/TrackedFeatures.h>

#include "laparoscope_servo/servo/task_config.h"
#include "laparoscope_servo/servo/task_error_input.h"
#include "ros/controller/feature_camera.h"

namespace laparoscope_servo {

// The object's place is the middle of its region, which goes along with its motion from image to image and is compared
// with the first one. Where it cannot be compared its expected error grows, as is counted from the selection on, and an
// image in which the motion was not seen ends what is known of it.
class ObjectPlace {
 public:
  explicit ObjectPlace(const servo::FollowConfig& config) : config_(config) {}

  // Call for each message. Not valid unless the motion is TRACKING; `problem` says what is wrong with the message or
  // the camera, or that the object was lost. The caller fills in the ages.
  servo::TaskErrorInput from(const TrackedFeatures& message, const FeatureCamera& camera);

 private:
  servo::FollowConfig config_;
  ros::Time selected_;     // stamp of the selection
  double variance_ = 0.0;  // px^2, of the place since the selection
  bool is_lost_ = false;   // since the selection
};

}  // namespace laparoscope_servo
