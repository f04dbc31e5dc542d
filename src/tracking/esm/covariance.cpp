#include "tracking/esm/covariance.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "tracking/esm/normal_equations.h"

namespace laparoscope_servo::tracking {

namespace {

constexpr double kSingular = 1e-12;  // conditioning below which the equations count as singular

// px in the image, standard deviation of the image of a point of the ROI; infinite where the covariance gives none.
double pointError(const Eigen::Matrix3d& g, const geometry::Rectangle& roi, const Eigen::Vector2d& point,
                  const Matrix8d& covariance) {
  const Eigen::Matrix<double, 2, 8> j =
      halfSize(roi) * geometry::derivative(g, point) * pointJacobian(geometry::apply(templateFromPixels(roi), point));
  const double variance = (j * covariance * j.transpose()).trace();
  return variance >= 0.0 ? std::sqrt(variance) : std::numeric_limits<double>::infinity();
}

}  // namespace

// The covariance by the residuals is A^-1 B A^-1 with A = J'WJ and B the sum of the blocks' (J'Wr)(J'Wr)', which
// includes the correlation of residuals within a block. `noise` is the scale for which A/noise matches the inverse of
// that covariance.
EstimateCovariance estimateCovariance(const Matrix10d& matrix, const std::vector<LightBlockSums>& blocks, double sigma,
                                      const Matrix8d& prior) {
  Matrix10d scores = Matrix10d::Zero();
  int count = 0;
  for (const LightBlockSums& sums : blocks) {
    if (!(sums.weight > 0.0)) continue;
    scores += sums.score * sums.score.transpose();
    ++count;
  }
  EstimateCovariance result;
  result.noise = sigma * sigma;
  Matrix8d information = Matrix8d::Zero();
  const Factors<10> factors(matrix);
  if (factors.conditioning() > kSingular) {
    const Matrix10d inverse = factors.solve(Matrix10d::Identity());
    const Matrix8d shape = inverse.topLeftCorner<8, 8>();
    const Matrix8d seen = (inverse * scores * inverse).topLeftCorner<8, 8>();
    const Factors<8> of_shape(shape);
    // Nine unknowns were fitted to the blocks.
    const double freedom = std::max(1.0, count - 9.0) / std::max(1, count);
    const double seen_noise = of_shape.solve(seen).trace() / 8.0 / freedom;
    if (std::isfinite(seen_noise)) result.noise = std::max(result.noise, seen_noise);
    information = of_shape.solve(Matrix8d::Identity()) / result.noise;
  }
  information += prior;
  const Factors<8> posterior(information);
  if (posterior.conditioning() > kSingular) result.covariance = Matrix8d(posterior.solve(Matrix8d::Identity()));
  return result;
}

std::optional<Matrix8d> covarianceOfNoise(const Matrix10d& matrix, double variance) {
  const Factors<10> factors(matrix);
  if (!(factors.conditioning() > kSingular)) return std::nullopt;
  const Matrix10d inverse = factors.solve(Matrix10d::Identity());
  return Matrix8d(variance * inverse.topLeftCorner<8, 8>());
}

double cornerError(const Eigen::Matrix3d& g, const geometry::Rectangle& roi, const Matrix8d& covariance) {
  double worst = 0.0;
  for (const Eigen::Vector2d& corner : roi.corners()) worst = std::max(worst, pointError(g, roi, corner, covariance));
  return worst;
}

double centreError(const Eigen::Matrix3d& g, const geometry::Rectangle& roi, const Matrix8d& covariance) {
  return pointError(g, roi, roi.centre(), covariance);
}

}  // namespace laparoscope_servo::tracking
