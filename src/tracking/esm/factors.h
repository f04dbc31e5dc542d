// Solves symmetric equations whose unknowns have different units.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>

namespace laparoscope_servo::tracking {

// The matrix has its diagonal divided out: grey levels and normalised coordinates have nothing to do with each other.
template <int N>
class Factors {
 public:
  using Matrix = Eigen::Matrix<double, N, N>;
  // `a`: symmetric, positive semidefinite.
  explicit Factors(const Matrix& a)
      : d_(a.diagonal().cwiseMax(1e-12).cwiseSqrt().cwiseInverse()), ldlt_(d_.asDiagonal() * a * d_.asDiagonal()) {}
  // 0 for a singular matrix, 1 for a diagonal one.
  double conditioning() const { return ldlt_.info() == Eigen::Success ? ldlt_.vectorD().minCoeff() : 0.0; }
  template <typename Right>
  auto solve(const Right& b) const {
    return (d_.asDiagonal() * ldlt_.solve(d_.asDiagonal() * b)).eval();
  }

 private:
  Eigen::Matrix<double, N, 1> d_;
  Eigen::LDLT<Matrix> ldlt_;
};

}  // namespace laparoscope_servo::tracking
