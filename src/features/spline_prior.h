// What is known of a spline's shape from one image to the next.
#pragma once

#include <Eigen/Core>

#include "laparoscope_servo/features/spline.h"

namespace laparoscope_servo::features {

// How much a contour deforms between two images, px, standard deviations at each control point.
struct Deformation {
  double bend;   // against the mean of its two neighbours
  double whole;  // against where a similarity takes it
};

// Inverse covariance of the displacements along normals, of `size` control points.
Spline::Matrix stiffness(int size, bool closed, const Deformation& deformation);

// Displacements of the control points along their normals, in four ways, one each column.
using Modes = Eigen::Matrix<double, Eigen::Dynamic, 4, 0, Spline::kMostPoints, 4>;
// The inverse covariance of a contour that is displaced by each mode besides, with this standard deviation: that of
// stiffness^-1 + deviation^2 modes modes', by Woodbury's identity, which needs no inverse but one of 4 x 4.
Spline::Matrix freed(const Spline::Matrix& stiffness, const Modes& modes, double deviation);

// The similarity that takes the points `from` next to the points `to`, by least squares: linear part and translation.
struct Similarity {
  Similarity(const Spline::Points& from, const Spline::Points& to, int size);
  Eigen::Vector2d operator()(const Eigen::Vector2d& p) const { return linear * p + translation; }
  double scale() const { return linear.col(0).norm(); }

  Eigen::Matrix2d linear;
  Eigen::Vector2d translation;
};

struct Extent {
  Extent(const Spline::Points& points, int size);
  Eigen::Vector2d centre;
  double radius;  // px, root of the mean square distance from the centre
};

}  // namespace laparoscope_servo::features
