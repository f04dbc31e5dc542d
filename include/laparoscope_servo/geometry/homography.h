// Homographies between two images of a plane.
//
// G takes homogeneous pixels of the reference image to pixels of the current one, H does the same for normalised
// points: H = K^-1 G K (Bourger et al. 2007, section III). Defined up to scale; each function says which scale it
// gives.
#pragma once

#include <Eigen/Geometry>
#include <array>

#include "laparoscope_servo/geometry/camera.h"

namespace laparoscope_servo::geometry {

// Top left, top right, bottom right, bottom left, seen from the reference image.
using Quadrilateral = std::array<Eigen::Vector2d, 4>;

// A rectangle with sides along the image's: px. The ROI of pixels x .. x + width - 1, y .. y + height - 1.
struct Rectangle {
  double x = 0.0;
  double y = 0.0;
  double width = 0.0;
  double height = 0.0;

  Eigen::Vector2d centre() const { return {x + (width - 1.0) / 2.0, y + (height - 1.0) / 2.0}; }
  // Centres of the corner pixels.
  Quadrilateral corners() const;
};

// H = K^-1 G K, determinant 1 when G's is.
Eigen::Matrix3d normalisedFromPixels(const Eigen::Matrix3d& g, const PinholeCamera& camera);
// G = K H K^-1, determinant 1 when H's is.
Eigen::Matrix3d pixelsFromNormalised(const Eigen::Matrix3d& h, const PinholeCamera& camera);

// The point that the homography takes `p` to. Not finite where p goes to infinity.
Eigen::Vector2d apply(const Eigen::Matrix3d& g, const Eigen::Vector2d& p);
// Applies it to all four corners. If their denominators do not have one sign, all corners are NaN: a quadrilateral
// through infinity is no image of the rectangle.
Quadrilateral apply(const Eigen::Matrix3d& g, const Quadrilateral& q);
// The derivative of apply(g, p) by p: the motion of the image point for a motion of the point.
Eigen::Matrix2d derivative(const Eigen::Matrix3d& g, const Eigen::Vector2d& p);

// Signed area in px², positive when the corners turn clockwise as seen in the image (as a Rectangle's do).
double signedArea(const Quadrilateral& q);

// The largest distance between corresponding corners; infinite if a corner is not finite, so that it never counts as
// near.
double largestDistance(const Quadrilateral& a, const Quadrilateral& b);
// largestDistance() [px] between a rectangle's corners under two homographies.
double cornerDistance(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b, const Rectangle& rectangle);

// Strictly convex, turning as a Rectangle's corners do, and finite.
bool isConvex(const Quadrilateral& q);

// The homography that takes the corners of one quadrilateral to those of another, determinant 1. Throws
// std::invalid_argument when three corners of either are on a line.
Eigen::Matrix3d fromCorners(const Quadrilateral& from, const Quadrilateral& to);

// The Euclidean homography R + t n'/d of the plane n'X = d, for the motion current_T_reference. `n` is a unit vector in
// the reference camera's frame, d > 0 the distance [m] of the plane from its centre. Its median singular value is 1.
Eigen::Matrix3d fromPlane(const Eigen::Isometry3d& current_T_reference, const Eigen::Vector3d& n, double d);

// G = K (R + t n'/d) K^-1, determinant 1: where the pixels of that plane go between the two images of `camera`. Throws
// std::invalid_argument when d is not positive, a value is not finite, or the camera has passed through the plane.
Eigen::Matrix3d pixelsFromPlane(const Eigen::Isometry3d& current_T_reference, const Eigen::Vector3d& n, double d,
                                const PinholeCamera& camera);

// H scaled so that it is R + t n'/d: divided by its median singular value, with the sign that keeps `m` in front of the
// camera, m'H m > 0. Throws std::invalid_argument when H is not finite or has rank below 2.
Eigen::Matrix3d euclideanScale(const Eigen::Matrix3d& h, const Eigen::Vector3d& m);

}  // namespace laparoscope_servo::geometry
