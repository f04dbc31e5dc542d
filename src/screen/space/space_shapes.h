// What is drawn in space, as points and lines. m, in the frame that each function names. No ROS, no widgets, no Ogre.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <utility>
#include <vector>

#include "laparoscope_servo/geometry/camera.h"

namespace laparoscope_servo::screen {

using Corners3 = std::array<Eigen::Vector3d, 4>;
using Lines = std::vector<std::pair<Eigen::Vector3d, Eigen::Vector3d>>;

// How far the controller lets the scope go.
struct ScopeBounds {
  double min_depth = 0.0;  // m, of the camera beyond the insertion point
  double max_depth = 0.0;
  double cone = 0.0;                                 // rad, from the axis to the shaft
  Eigen::Vector3d axis = -Eigen::Vector3d::UnitZ();  // in the insertion point's frame, into the body
};

// Where a point is, by its covariance.
struct Ellipsoid {
  Eigen::Matrix3d axes;   // a rotation; its columns
  Eigen::Vector3d radii;  // m, along them
};

// The region's corners in the camera's frame: where the plane has gone that was seen squarely, `depth` in front of the
// camera, when the region was selected. `region` and `g` as in Homography.msg. Empty when a corner would not lie in
// front of the camera, or something is not finite.
std::optional<Corners3> regionInSpace(const geometry::PinholeCamera& camera, const std::array<double, 9>& g,
                                      const std::array<double, 8>& region, double depth);

// Two shells, where the camera has its least and its greatest depth, and the cone between; in the insertion point's
// frame. Empty for bounds that are none.
Lines boundLines(const ScopeBounds& bounds);

// Of twice the standard deviation; empty when `covariance` [m²] is none.
std::optional<Ellipsoid> ellipsoidOf(const Eigen::Matrix3d& covariance);

}  // namespace laparoscope_servo::screen
