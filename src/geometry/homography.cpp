#include "laparoscope_servo/geometry/homography.h"

#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "laparoscope_servo/geometry/sl3.h"

namespace laparoscope_servo::geometry {

namespace {

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

// Takes the projective basis (e1, e2, e3, e1 + e2 + e3) to the four corners.
Eigen::Matrix3d fromBasis(const Quadrilateral& q) {
  Eigen::Matrix3d p;
  for (int k = 0; k < 3; ++k) p.col(k) = q[k].homogeneous();
  const Eigen::Vector3d weights = p.partialPivLu().solve(Eigen::Vector3d(q[3].homogeneous()));
  const Eigen::Matrix3d basis = p * weights.asDiagonal();
  const double size = p.topRows<2>().cwiseAbs().maxCoeff();
  if (!weights.allFinite() || weights.cwiseAbs().minCoeff() < 1e-12 ||
      std::abs(p.determinant()) < 1e-12 * size * size) {
    throw std::invalid_argument("quadrilateral has three corners on a line, expected a convex one");
  }
  return basis;
}

}  // namespace

Quadrilateral Rectangle::corners() const {
  const double right = x + width - 1.0;
  const double bottom = y + height - 1.0;
  return {Eigen::Vector2d(x, y), Eigen::Vector2d(right, y), Eigen::Vector2d(right, bottom), Eigen::Vector2d(x, bottom)};
}

Eigen::Matrix3d normalisedFromPixels(const Eigen::Matrix3d& g, const PinholeCamera& camera) {
  return camera.inverseMatrix() * g * camera.matrix();
}

Eigen::Matrix3d pixelsFromNormalised(const Eigen::Matrix3d& h, const PinholeCamera& camera) {
  return camera.matrix() * h * camera.inverseMatrix();
}

Eigen::Vector2d apply(const Eigen::Matrix3d& g, const Eigen::Vector2d& p) {
  const Eigen::Vector3d q = g * p.homogeneous();
  return q.head<2>() / q.z();
}

Quadrilateral apply(const Eigen::Matrix3d& g, const Quadrilateral& q) {
  Quadrilateral result;
  int in_front = 0;
  for (int k = 0; k < 4; ++k) {
    const Eigen::Vector3d p = g * q[k].homogeneous();
    if (p.z() > 0.0) ++in_front;
    result[k] = p.head<2>() / p.z();
  }
  if (in_front != 0 && in_front != 4) {
    result.fill(Eigen::Vector2d::Constant(std::numeric_limits<double>::quiet_NaN()));
  }
  return result;
}

Eigen::Matrix2d derivative(const Eigen::Matrix3d& g, const Eigen::Vector2d& p) {
  const Eigen::Vector3d q = g * p.homogeneous();
  const Eigen::Vector2d image = q.hnormalized();
  return (g.topLeftCorner<2, 2>() - image * g.bottomLeftCorner<1, 2>()) / q.z();
}

double signedArea(const Quadrilateral& q) {
  return 0.5 * cross(q[2] - q[0], q[3] - q[1]);
}

double largestDistance(const Quadrilateral& a, const Quadrilateral& b) {
  double largest = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    const double distance = (a[k] - b[k]).norm();
    if (!std::isfinite(distance)) return std::numeric_limits<double>::infinity();
    largest = std::max(largest, distance);
  }
  return largest;
}

double cornerDistance(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b, const Rectangle& rectangle) {
  return largestDistance(geometry::apply(a, rectangle.corners()), geometry::apply(b, rectangle.corners()));
}

bool isConvex(const Quadrilateral& q) {
  for (int k = 0; k < 4; ++k) {
    const Eigen::Vector2d side = q[(k + 1) % 4] - q[k];
    const Eigen::Vector2d next = q[(k + 2) % 4] - q[(k + 1) % 4];
    if (!(cross(side, next) > 0.0)) return false;
  }
  return true;
}

Eigen::Matrix3d fromCorners(const Quadrilateral& from, const Quadrilateral& to) {
  return normaliseDeterminant(fromBasis(to) * fromBasis(from).inverse());
}

Eigen::Matrix3d fromPlane(const Eigen::Isometry3d& current_T_reference, const Eigen::Vector3d& n, double d) {
  return current_T_reference.linear() + current_T_reference.translation() * n.transpose() / d;
}

Eigen::Matrix3d pixelsFromPlane(const Eigen::Isometry3d& current_T_reference, const Eigen::Vector3d& n, double d,
                                const PinholeCamera& camera) {
  if (!(d > 0.0))
    throw std::invalid_argument("plane at the distance " + std::to_string(d) + " m, expected a positive one");
  const Eigen::Matrix3d h = fromPlane(current_T_reference, n, d);
  if (!(h.determinant() > 0.0)) {  // also for NaN
    throw std::invalid_argument("motion is not finite, or takes the camera through the plane that it looks at");
  }
  return normaliseDeterminant(pixelsFromNormalised(h, camera));
}

Eigen::Matrix3d euclideanScale(const Eigen::Matrix3d& h, const Eigen::Vector3d& m) {
  if (!h.allFinite()) throw std::invalid_argument("homography is not finite");
  const Eigen::Vector3d values = Eigen::JacobiSVD<Eigen::Matrix3d>(h).singularValues();
  if (!(values[1] > 1e-12 * values[0])) {
    throw std::invalid_argument("homography has rank below 2, expected the image of a plane");
  }
  const double sign = m.dot(h * m) < 0.0 ? -1.0 : 1.0;
  return sign / values[1] * h;
}

}  // namespace laparoscope_servo::geometry
