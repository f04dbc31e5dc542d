// Parametric models of the motion in an image: section IV.A of Marchand and Chaumette (2004), eq. (8).
//
// A point at p = (x, y) from the centre moves with the velocity
//   (a0 + a2 x + a3 y + a6 x^2 + a7 x y,  a1 + a4 x + a5 y + a6 x y + a7 y^2).
// That is the motion of a plane before a moving camera. The velocities of eq. (8) are the tangent space of the
// homographies: followed for a unit of time they displace an image by one homography, exactly. So motion between two
// images is kept as a homography, and told as the parameters whose flow it is.
#pragma once

#include <Eigen/Core>

#include "laparoscope_servo/geometry/homography.h"
#include "laparoscope_servo/geometry/sl3.h"

namespace laparoscope_servo::motion {

// Each model has those of the one before, and more.
enum class Model {
  kConstant = 0,   // a0, a1
  kAffine = 1,     // a0 to a5
  kQuadratic = 2,  // a0 to a7
};

// 2, 6 or 8.
int parametersOf(Model model);

struct MotionField {
  // a0 to a7 [px, 1, 1/px, each by the unit of time]; those that the model does not have are 0.
  geometry::Vector8d a = geometry::Vector8d::Zero();
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();  // px

  // Eq. (8), for a pixel of the image.
  Eigen::Vector2d at(const Eigen::Vector2d& pixel) const;
};

// The derivative of MotionField::at by a, at `p` from the centre.
Eigen::Matrix<double, 2, 8> fieldJacobian(const Eigen::Vector2d& p);

// Px, the standard deviation of MotionField::at at the worst of these corners, px: the root of the sum of the variances
// of its two components. `covariance`: of a, about `centre`, px.
double errorAtCorners(const geometry::Quadrilateral& corners, const Eigen::Vector2d& centre,
                      const Eigen::Matrix<double, 8, 8>& covariance);

// From a to the parameters of the same field about another centre, which lies `by` px from theirs: a' = T a.
Eigen::Matrix<double, 8, 8> fieldAbout(const Eigen::Vector2d& by);

// Where pixels are after a unit of time, determinant 1.
Eigen::Matrix3d homographyOf(const MotionField& field);
// The field whose flow that is. Not finite where the homography has no principal logarithm (see geometry::sl3Log).
MotionField fieldOf(const Eigen::Matrix3d& g, const Eigen::Vector2d& centre);

// From x of sl(3), in coordinates about the centre whose unit is `unit` px (see geometry::Sl3Steps), to a: a = T x.
Eigen::Matrix<double, 8, 8> fieldFromSl3(double unit);

}  // namespace laparoscope_servo::motion
