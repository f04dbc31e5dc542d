#include "screen/features/feature_spread.h"

#include <laparoscope_servo/TrackedFeature.h>

#include <Eigen/Eigenvalues>
#include <cmath>

#include "screen/deviations.h"

namespace laparoscope_servo::screen {

namespace {

constexpr std::size_t kLineParameters = 2;
constexpr std::size_t kEllipseParameters = 5;

Eigen::Map<const Eigen::MatrixXd> covarianceOf(const FeatureFact& feature) {
  const auto size = static_cast<Eigen::Index>(feature.parameters.size());
  return {feature.covariance.data(), size, size};  // symmetric, so that the order does not matter
}

// x cos(theta) + y sin(theta) = rho: a point of the line moves by d rho - t d theta along the normal, with its place t
// along the line.
double spreadOfLine(const FeatureFact& feature, const QPointF& at) {
  const double theta = feature.parameters[1];
  const double along = -at.x() * std::sin(theta) + at.y() * std::cos(theta);
  const Eigen::Vector2d gradient(1.0, -along);
  return gradient.dot(covarianceOf(feature) * gradient);
}

// x^2 + K1 y^2 + 2 K2 x y + 2 K3 x + 2 K4 y + K5 = 0: its points move by -dK . (df/dK) / |df/d(x, y)|.
double spreadOfEllipse(const FeatureFact& feature, const QPointF& at) {
  const std::vector<double>& k = feature.parameters;
  const double x = at.x(), y = at.y();
  Eigen::Matrix<double, 5, 1> gradient;
  gradient << y * y, 2.0 * x * y, 2.0 * x, 2.0 * y, 1.0;
  const Eigen::Vector2d normal(2.0 * (x + k[1] * y + k[2]), 2.0 * (k[0] * y + k[1] * x + k[3]));
  return gradient.dot(covarianceOf(feature) * gradient) / normal.squaredNorm();
}

}  // namespace

std::vector<double> spreadAlong(const FeatureFact& feature) {
  std::vector<double> spread;
  for (const QPointF& at : feature.outline) {
    double variance = feature.expected_error * feature.expected_error;
    if (feature.kind == TrackedFeature::LINE || feature.kind == TrackedFeature::ELLIPSE) {
      const bool line = feature.kind == TrackedFeature::LINE;
      if (feature.covariance.empty() || feature.parameters.size() != (line ? kLineParameters : kEllipseParameters))
        return {};
      variance = line ? spreadOfLine(feature, at) : spreadOfEllipse(feature, at);
    } else if (feature.kind != TrackedFeature::SPLINE && feature.kind != TrackedFeature::HOMOGRAPHY) {
      return {};
    }
    if (!(variance >= 0.0) || !std::isfinite(variance)) return {};
    spread.push_back(std::sqrt(variance));
  }
  return spread;
}

std::optional<Eigen::Matrix2d> spreadAround(const FeatureFact& feature) {
  if (feature.kind != TrackedFeature::POINT || feature.parameters.size() != 2 || feature.covariance.empty())
    return std::nullopt;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(Eigen::Matrix2d(covarianceOf(feature)));
  if (solver.info() != Eigen::Success || !(solver.eigenvalues()[1] > 0.0)) return std::nullopt;
  return Eigen::Matrix2d(kDeviations * solver.eigenvectors() *
                         solver.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal());
}

}  // namespace laparoscope_servo::screen
