// How far the scope may go: a range of depths, and a cone of directions about the insertion point.
//
// Towards a bound it is slowed down, and at the bound it goes no further; back it may always.
#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "laparoscope_servo/scope/velocity.h"

namespace laparoscope_servo::servo {

struct WorkRange {
  double min_depth = 0.03;     // m, of the camera beyond the insertion point, d2
  double max_depth = 0.22;     // m
  double depth_margin = 0.01;  // m, slowed from here to a bound
  std::vector<double> axis{0.0, 0.0,
                           -1.0};  // of the cone, in the insertion point's frame, into the body; of any length but 0
  double cone = 1.2;               // rad, from the axis to the shaft
  double cone_margin = 0.1;        // rad, slowed from here to the bound
};

// What of a velocity is done at a depth d2 [m] with the shaft's axes in the insertion point's frame.
scope::Velocity within(const WorkRange& range, const scope::Velocity& velocity, double d2,
                       const Eigen::Matrix3d& insertion_point_R_shaft);

// The same without the cone, where the directions are not known.
scope::Velocity within(const WorkRange& range, const scope::Velocity& velocity, double d2);

}  // namespace laparoscope_servo::servo
