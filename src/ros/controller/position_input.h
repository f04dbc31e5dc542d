// The task error by the homography of the region, from what the tracker says: the input of the task POSITION.
#pragma once

#include <laparoscope_servo/Homography.h>
#include <laparoscope_servo/TaskError.h>

#include "laparoscope_servo/servo/controller.h"
#include "ros/controller/selection_scope.h"

namespace laparoscope_servo {

class PositionInput {
 public:
  // `desired_depth`: Z* [m].
  explicit PositionInput(double desired_depth) : desired_depth_(desired_depth) {}

  // Call for each task error: it tells where the region's middle was in the reference image.
  void know(const TaskError& message);

  // Not valid unless the region is TRACKING; `problem` says what is wrong with the message or `depth`. The caller fills
  // in the ages.
  servo::TaskErrorInput from(const Homography& message, const servo::DepthInput& depth);

 private:
  double desired_depth_;  // m
  ros::Time region_;      // reference_stamp of the last task error
  Eigen::Vector3d m_star_ = Eigen::Vector3d::Zero();
  SelectionScope scope_;
};

}  // namespace laparoscope_servo
