// SL(3), the group of homographies with determinant 1, and its algebra sl(3), the 3x3 matrices with trace 0.
//
// Coordinates in the algebra are the eight x_k of A(x) = sum x_k A_k with
//   A1 = e1e3', A2 = e2e3', A3 = e1e2', A4 = e2e1', A5 = e1e1' - e2e2', A6 = e3e3' - e2e2', A7 = e3e1', A8 = e3e2'
// (Benhimane and Malis; the order that ESM's Jacobian has here). No unit: homographies act on coordinates that the
// caller has normalised.
#pragma once

#include <Eigen/Core>

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

}  // namespace laparoscope_servo::geometry
