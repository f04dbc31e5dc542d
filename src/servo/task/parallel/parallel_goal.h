// Where the scope's image plane is parallel to the tissue, with pan and tilt alone, and what leads there.
#pragma once

#include <Eigen/Geometry>
#include <string>

#include "laparoscope_servo/scope/geometry.h"
#include "laparoscope_servo/servo/shaping_config.h"
#include "laparoscope_servo/servo/task_config.h"
#include "laparoscope_servo/servo/task_function.h"

namespace laparoscope_servo::servo {

// The plane of the tissue in the frame of the insertion point: points X with normal'X = distance.
struct TissuePlane {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  // from the insertion point into the tissue
  double distance = 0.0;                              // m > 0
};

// The shaft's turn, by pan and tilt, that brings the optical axis to this direction, both in the shaft's axes: R with
// R axis = direction. Not finite where no pan and tilt do.
Eigen::Matrix3d turnTo(const Eigen::Vector3d& direction, const Eigen::Vector3d& axis);

// The task error of the point that the axis will meet Z* before the camera, once it has this direction: it is at
// rest in the base, and in the middle of the image at the goal. Not finite where that point is not before the camera.
TaskError errorTowards(const Eigen::Vector3d& normal_in_shaft, const scope::Geometry& scope, double desired_depth);

// What the turn from a pose will do.
struct ParallelPlan {
  double turn = 0.0;          // rad
  double way = 0.0;           // m, over the tissue, of the point in the middle of the image
  double distance = 0.0;      // m, from the camera to the tissue along the optical axis, before
  double remaining = 0.0;     // m, the same at the goal
  std::string problem;        // why it is not to be done; empty: nothing is in the way
  std::string words() const;  // what will happen
};

ParallelPlan planned(const TissuePlane& tissue, const Eigen::Isometry3d& base_T_tip, const scope::Geometry& scope,
                     const ParallelConfig& config, const Workspace& range);

}  // namespace laparoscope_servo::servo
