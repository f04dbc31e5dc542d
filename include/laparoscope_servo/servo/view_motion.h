// How the view has moved since an anchor image, as a homography.
#pragma once

#include <Eigen/Core>

#include "laparoscope_servo/geometry/homography.h"

namespace laparoscope_servo::servo {

struct ViewMotion {
  Eigen::Matrix3d h = Eigen::Matrix3d::Identity();  // normalised points of the anchor to those of this image, any scale
  geometry::Quadrilateral corners{};                // of viewRegion(), normalised
  double error = 0.0;                               // normalised, one standard deviation at the worst corner
};

}  // namespace laparoscope_servo::servo
