#include "laparoscope_servo/robust/irls.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "laparoscope_servo/robust/mad.h"
#include "laparoscope_servo/robust/weights.h"

namespace laparoscope_servo::robust {

namespace {

// Of the pivots of A'WA: below it a direction is not determined in double precision.
constexpr double kLeastPivot = 1e-12;

// Adds a row's part of A'WA, of which the lower triangle is used, and of A'Wb: coefficients side by side.
template <int kCount>
void addBlock(const Row& row, double weight, Eigen::MatrixXd& normal, Eigen::VectorXd& right) {
  const Eigen::Index rows = normal.rows();
  double* const sums = right.data() + row.first;
  double* column = normal.data() + row.first * (rows + 1);
  for (std::size_t l = 0; l < kCount; ++l, column += rows) {
    const double scaled = weight * row.a[l];
    sums[l] += scaled * row.b;
    for (std::size_t k = l; k < kCount; ++k) column[k] += scaled * row.a[k];
  }
}

// Of the numbers of coefficients that there are, each has loops of its own.
void addBlock(const Row& row, double weight, Eigen::MatrixXd& normal, Eigen::VectorXd& right) {
  static_assert(Row::kMost == 8);
  switch (row.count) {
    case 1:
      return addBlock<1>(row, weight, normal, right);
    case 2:
      return addBlock<2>(row, weight, normal, right);
    case 3:
      return addBlock<3>(row, weight, normal, right);
    case 4:
      return addBlock<4>(row, weight, normal, right);
    case 5:
      return addBlock<5>(row, weight, normal, right);
    case 6:
      return addBlock<6>(row, weight, normal, right);
    case 7:
      return addBlock<7>(row, weight, normal, right);
    case 8:
      return addBlock<8>(row, weight, normal, right);
  }
}

// The same of coefficients that go on at the first column.
void addRound(const Row& row, double weight, Eigen::MatrixXd& normal, Eigen::VectorXd& right) {
  for (int k = 0; k < row.count; ++k) {
    const double scaled = weight * row.a[static_cast<std::size_t>(k)];
    const Eigen::Index r = columnOf(row.first, k, right.size());
    right[r] += scaled * row.b;
    for (int l = 0; l <= k; ++l) {
      const Eigen::Index c = columnOf(row.first, l, right.size());
      normal(std::max(r, c), std::min(r, c)) += scaled * row.a[static_cast<std::size_t>(l)];
    }
  }
}

double product(const Row& row, const Eigen::VectorXd& x) {
  double sum = 0.0;
  if (row.first + row.count <= x.size()) {
    const double* const own = x.data() + row.first;
    for (int k = 0; k < row.count; ++k) sum += row.a[static_cast<std::size_t>(k)] * own[k];
  } else {
    for (int k = 0; k < row.count; ++k) sum += row.a[static_cast<std::size_t>(k)] * x[columnOf(row.first, k, x.size())];
  }
  return sum;
}

}  // namespace

void Irls::reserve(int unknowns, int rows) {
  solver_ = Eigen::LDLT<Eigen::MatrixXd>(unknowns);
  for (Eigen::VectorXd* vector : {&x_, &next_, &right_}) vector->setZero(unknowns);
  for (Eigen::MatrixXd* matrix : {&normal_, &covariance_}) matrix->setZero(unknowns, unknowns);
  for (std::vector<double>* values : {&residuals_, &scratch_, &weights_}) {
    values->reserve(static_cast<std::size_t>(rows));
  }
}

bool Irls::step(const std::vector<Row>& rows, double variance, const Eigen::MatrixXd& information,
                const Eigen::VectorXd& expected) {
  const int unknowns = static_cast<int>(x_.size());
  if (information.size() > 0) {
    normal_ = variance * information;
  } else {
    normal_.setZero();
  }
  if (information.size() > 0 && expected.size() > 0) {
    right_.noalias() = normal_ * expected;
  } else {
    right_.setZero();
  }
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Row& row = rows[i];
    const double weight = row.weight * weights_[i];
    if (!(weight > 0.0)) continue;
    if (row.first + row.count <= unknowns) {
      addBlock(row, weight, normal_, right_);
    } else {
      addRound(row, weight, normal_, right_);
    }
  }
  solver_.compute(normal_);
  const double largest = solver_.vectorD().maxCoeff();
  if (!(solver_.vectorD().minCoeff() > kLeastPivot * largest)) return false;
  next_ = right_;
  solver_.solveInPlace(next_);
  return next_.allFinite();
}

IrlsResult Irls::fail(IrlsResult result) {
  x_.setZero();
  result.solved = false;
  return result;
}

IrlsResult Irls::solve(int unknowns, const std::vector<Row>& rows, const IrlsConfig& config,
                       const Eigen::MatrixXd& information, const Eigen::VectorXd& expected) {
  if (x_.size() != unknowns) reserve(unknowns, static_cast<int>(rows.size()));
  IrlsResult result;
  x_.setZero();
  weights_.assign(rows.size(), 1.0);
  double least = std::max(config.min_sigma, config.start_sigma);
  for (; result.iterations < config.max_iterations; ++result.iterations) {
    residuals_.clear();
    scratch_.clear();
    for (const Row& row : rows) {
      residuals_.push_back(row.b - product(row, x_));
      if (!(row.weight > 0.0)) continue;
      if (!std::isfinite(residuals_.back())) return fail(result);
      scratch_.push_back(residuals_.back());
    }
    if (scratch_.empty()) return fail(result);
    const Spread spread = robust::spread(scratch_);
    result.sigma = std::max(least, spread.sigma);
    const bool is_final = !(least > config.min_sigma);
    least = std::max(config.min_sigma, 0.5 * least);
    // Eq. (11): the residual about its median, in standard deviations. Where more than half of them agree exactly the
    // scale is 0, and those alone count.
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const double centred = residuals_[i] - spread.centre;
      const double u = result.sigma > 0.0 ? centred / result.sigma : centred == 0.0 ? 0.0 : 2.0 * kTukey;
      weights_[i] = config.weights == Weights::kTukey ? tukeyWeight(u) : huberWeight(u);
    }
    if (!step(rows, result.sigma * result.sigma, information, expected)) return fail(result);
    const double change = (next_ - x_).lpNorm<Eigen::Infinity>();
    x_.swap(next_);
    result.solved = true;
    if (is_final && !(change > config.min_step)) {
      ++result.iterations;
      break;
    }
  }
  covariance_.setIdentity();
  solver_.solveInPlace(covariance_);
  covariance_ *= result.sigma * result.sigma;
  return result;
}

}  // namespace laparoscope_servo::robust
