// The task error of points, from what the nodelet Points says: the input of the task POINTS.
#pragma once

#include <laparoscope_servo/TrackedFeatures.h>

#include <vector>

#include "laparoscope_servo/servo/controller.h"
#include "laparoscope_servo/servo/points_error.h"
#include "ros/controller/feature_camera.h"
#include "ros/controller/selection_scope.h"

namespace laparoscope_servo {

class PointsInput {
 public:
  PointsInput(const servo::PointsConfig& config, double desired_depth)
      : config_(config), error_(config, desired_depth) {}

  // By the points that are TRACKING and were selected with desired places. Not valid unless enough of them agree;
  // `problem` says what is wrong with the message, the camera or `depth`. The caller fills in the ages.
  servo::TaskErrorInput from(const TrackedFeatures& message, const FeatureCamera& camera,
                             const servo::DepthInput& depth);

 private:
  void take(const TrackedFeatures& message, const FeatureCamera& camera);

  servo::PointsConfig config_;
  servo::PointsError error_;
  std::vector<servo::PointTask> points_;  // all that have a desired place; those that are not seen without weight
  Eigen::Vector2d middle_ = Eigen::Vector2d::Zero();  // normalised, of the desired places
  SelectionScope scope_;
};

}  // namespace laparoscope_servo
