// How far a feature may be from where it is drawn, by its covariance. px of the original image; no ROS, no widgets.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "screen/features/feature_facts.h"

namespace laparoscope_servo::screen {

// Of a LINE, an ELLIPSE, a SPLINE or a HOMOGRAPHY: the standard deviation along the normal at each point of the
// outline. That of the last two is their expected error everywhere. Empty when it is not known.
std::vector<double> spreadAlong(const FeatureFact& feature);

// Of a POINT: twice the standard deviations, as the columns of a matrix that takes the unit circle to the ellipse.
// Empty when it is not known.
std::optional<Eigen::Matrix2d> spreadAround(const FeatureFact& feature);

}  // namespace laparoscope_servo::screen
