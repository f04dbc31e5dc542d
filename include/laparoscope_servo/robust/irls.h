// Iteratively reweighted least squares: D A x = D b of Marchand and Chaumette (2004), appendix, with Tukey's or Huber's
// weights on the diagonal of D'D and the scale by MAD, eq. (11) to (13).
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <array>
#include <vector>

namespace laparoscope_servo::robust {

enum class Weights { kTukey, kHuber };

// One equation. Its coefficients that are not 0 lie side by side, and go on at the first column after the last one, as
// those of a closed spline do.
struct Row {
  static constexpr int kMost = 8;
  int first = 0;                  // column of the first coefficient
  int count = 0;                  // coefficients, at most kMost and at most the number of unknowns
  std::array<double, kMost> a{};  // of A
  double b = 0.0;                 // in the unit of min_sigma
  double weight = 1.0;            // what is known of it beforehand; a row without weight takes no part
};

// Column of the k-th coefficient of a row that begins at column `first`.
inline Eigen::Index columnOf(Eigen::Index first, Eigen::Index k, Eigen::Index unknowns) {
  const Eigen::Index column = first + k;
  return column < unknowns ? column : column - unknowns;
}

struct IrlsConfig {
  Weights weights = Weights::kTukey;
  int max_iterations = 20;
  double min_sigma = 0.0;  // the scale never falls below it: the noise that is known to be there
  // The scale of the first step is no smaller, and that of each further one no smaller than half of the one before:
  // rows that x brings together only later are not taken for outliers at once.
  double start_sigma = 0.0;
  double min_step = 1e-6;  // ends when no unknown changes by more
};

struct IrlsResult {
  bool solved = false;  // false: fewer rows than unknowns, or they do not determine them, or not finite; x is then 0
  int iterations = 0;
  double sigma = 0.0;  // robust standard deviation of the residuals b - A x, not below min_sigma
};

class Irls {
 public:
  // Up to so many unknowns and rows nothing is allocated afterwards.
  void reserve(int unknowns, int rows);

  // Starts from x = 0. `information`, unknowns x unknowns, is what is known of x beforehand, the inverse of its
  // covariance about `expected`; empty where nothing is, and `expected` where that is 0.
  IrlsResult solve(int unknowns, const std::vector<Row>& rows, const IrlsConfig& config,
                   const Eigen::MatrixXd& information = {}, const Eigen::VectorXd& expected = {});

  // Of the last solve() that returned solved.
  const Eigen::VectorXd& x() const { return x_; }
  // For each row, 0 to 1, without the weight it had beforehand.
  const std::vector<double>& weights() const { return weights_; }
  // sigma^2 (A'WA + sigma^2 information)^-1
  const Eigen::MatrixXd& covariance() const { return covariance_; }

 private:
  IrlsResult fail(IrlsResult result);
  bool step(const std::vector<Row>& rows, double variance, const Eigen::MatrixXd& information,
            const Eigen::VectorXd& expected);

  Eigen::VectorXd x_, next_, right_;
  Eigen::MatrixXd normal_, covariance_;
  Eigen::LDLT<Eigen::MatrixXd> solver_;
  std::vector<double> residuals_, scratch_, weights_;
};

}  // namespace laparoscope_servo::robust
