// SL(3), the group of homographies with determinant 1, and its algebra sl(3), the 3x3 matrices with trace 0.
//
// Coordinates in the algebra are the eight x_k of A(x) = sum x_k A_k with
//   A1 = e1e3', A2 = e2e3', A3 = e1e2', A4 = e2e1', A5 = e1e1' - e2e2', A6 = e3e3' - e2e2', A7 = e3e1', A8 = e3e2'
// (Benhimane and Malis; the order that ESM's Jacobian has here). No unit: homographies act on coordinates that the
// caller has normalised.
#pragma once

#include <Eigen/LU>

namespace laparoscope_servo::geometry {

using Vector8d = Eigen::Matrix<double, 8, 1>;

// A(x), trace 0.
Eigen::Matrix3d sl3Hat(const Vector8d& x);

// The inverse of sl3Hat for a matrix of trace 0; the trace of another matrix is ignored.
Vector8d sl3Vee(const Eigen::Matrix3d& a);

// exp(A(x)), determinant 1 to rounding. Finite for finite x; not finite otherwise.
Eigen::Matrix3d sl3Exp(const Vector8d& x);

// The principal logarithm's coordinates. Defined for G with determinant 1 and no eigenvalue on the closed negative real
// axis; not finite for another.
Vector8d sl3Log(const Eigen::Matrix3d& g);

// g / cbrt(det g): the same homography with determinant 1. Throws std::invalid_argument when g is not finite or its
// determinant is zero, or so small that the division overflows.
Eigen::Matrix3d normaliseDeterminant(const Eigen::Matrix3d& g);

// Steps between homographies in coordinates normalised by N: G + x = G N^-1 exp(A(x)) N. All eight directions have
// steps of similar size if N scales the region to a size of about 1.
class Sl3Steps {
 public:
  Sl3Steps() = default;
  // N must be invertible.
  explicit Sl3Steps(const Eigen::Matrix3d& n) : n_(n), n_inv_(n.inverse()) {}

  const Eigen::Matrix3d& normalisation() const { return n_; }

  // G + x; its determinant is that of `g` up to rounding.
  Eigen::Matrix3d plus(const Eigen::Matrix3d& g, const Vector8d& x) const;
  // The x with plus(from, x) = to, up to scale. Not finite where sl3Log is not; throws as normaliseDeterminant does.
  Vector8d minus(const Eigen::Matrix3d& to, const Eigen::Matrix3d& from) const;

 private:
  Eigen::Matrix3d n_ = Eigen::Matrix3d::Identity();
  Eigen::Matrix3d n_inv_ = Eigen::Matrix3d::Identity();
};

}  // namespace laparoscope_servo::geometry
