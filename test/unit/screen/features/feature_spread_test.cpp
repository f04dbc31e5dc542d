// The spread against that of curves whose parameters are drawn from the covariance.
#include "screen/features/feature_spread.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>
#include <limits>
#include <random>

#include "unit/screen/features/feature_facts_examples.h"

namespace laparoscope_servo::screen {
namespace {

using test_support::featuresMessage;

FeatureFact factOf(const TrackedFeature& message) {
  return featureResult(featuresMessage(1.0, {message}))->features[0];
}

Eigen::MatrixXd randomCovariance(Eigen::Index size, double scale, unsigned seed) {
  std::mt19937 generator(seed);
  std::normal_distribution<double> normal;
  Eigen::MatrixXd a(size, size);
  for (Eigen::Index k = 0; k < a.size(); ++k) a.data()[k] = normal(generator);
  return scale * (a * a.transpose() + 0.1 * Eigen::MatrixXd::Identity(size, size));
}

// Standard deviation of `distance`, of parameters drawn from the covariance, times 1.
template <class Distance>
double sampled(const Eigen::VectorXd& mean, const Eigen::MatrixXd& covariance, const Distance& distance) {
  std::mt19937 generator(7);
  std::normal_distribution<double> normal;
  const Eigen::MatrixXd factor = covariance.llt().matrixL();
  double sum = 0.0;
  constexpr int kDraws = 4000;
  for (int k = 0; k < kDraws; ++k) {
    Eigen::VectorXd step(mean.size());
    for (Eigen::Index i = 0; i < step.size(); ++i) step[i] = normal(generator);
    sum += std::pow(distance(Eigen::VectorXd(mean + factor * step)), 2);
  }
  return std::sqrt(sum / kDraws);
}

std::vector<double> numbers(const Eigen::MatrixXd& matrix) {
  return {matrix.data(), matrix.data() + matrix.size()};
}

TEST(FeatureSpread, OfALineIsThatOfItsPoints) {
  TrackedFeature line = test_support::lineMessage();
  const double rho = 140.0, theta = 0.7;
  Eigen::MatrixXd covariance(2, 2);
  covariance << 1e-2, 5e-5, 5e-5, 1e-6;
  line.parameters = {rho, theta};
  line.covariance = numbers(covariance);
  line.outline.clear();
  const Eigen::Vector2d normal(std::cos(theta), std::sin(theta)), along(-normal.y(), normal.x());
  for (const double t : {-150.0, 0.0, 400.0}) {
    const Eigen::Vector2d at = rho * normal + t * along;
    line.outline.insert(line.outline.end(), {at.x(), at.y()});
  }
  const std::vector<double> spread = spreadAlong(factOf(line));
  ASSERT_EQ(spread.size(), 3u);
  for (std::size_t k = 0; k < 3; ++k) {
    const Eigen::Vector2d at(line.outline[2 * k], line.outline[2 * k + 1]);
    const double expected = sampled(Eigen::Vector2d(rho, theta), covariance, [&](const Eigen::VectorXd& p) {
      return p[0] - at.x() * std::cos(p[1]) - at.y() * std::sin(p[1]);
    });
    EXPECT_NEAR(spread[k], expected, 0.05 * expected) << k;
  }
  EXPECT_GT(spread[2], spread[1]) << "further from where it is known it is known less";
}

TEST(FeatureSpread, OfAnEllipseIsThatOfItsPoints) {
  // (x - 160)^2 / 40^2 + (y - 120)^2 / 30^2 = 1, times 40^2
  const double q = 1600.0 / 900.0;
  const Eigen::Matrix<double, 5, 1> k(
      (Eigen::Matrix<double, 5, 1>() << q, 0.0, -160.0, -120.0 * q, 160.0 * 160.0 + q * 120.0 * 120.0 - 1600.0)
          .finished());
  const auto f = [](const Eigen::VectorXd& c, double x, double y) {
    return x * x + c[0] * y * y + 2 * c[1] * x * y + 2 * c[2] * x + 2 * c[3] * y + c[4];
  };
  TrackedFeature ellipse;
  ellipse.kind = TrackedFeature::ELLIPSE;
  ellipse.parameters = numbers(k);
  const Eigen::MatrixXd covariance = randomCovariance(5, 1e-8, 3);
  ellipse.covariance = numbers(covariance);
  for (const double turn : {0.0, 1.0, 4.0})
    ellipse.outline.insert(ellipse.outline.end(), {160.0 + 40.0 * std::cos(turn), 120.0 + 30.0 * std::sin(turn)});
  const std::vector<double> spread = spreadAlong(factOf(ellipse));
  ASSERT_EQ(spread.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    const Eigen::Vector2d at(ellipse.outline[2 * i], ellipse.outline[2 * i + 1]);
    ASSERT_NEAR(f(k, at.x(), at.y()), 0.0, 1e-6);
    const Eigen::Vector2d normal = Eigen::Vector2d((at.x() - 160.0) / 1600.0, (at.y() - 120.0) / 900.0).normalized();
    // Where it crosses the normal, by a step of Newton.
    const double expected = sampled(k, covariance, [&](const Eigen::VectorXd& c) {
      constexpr double h = 1e-3;
      const Eigen::Vector2d ahead = at + h * normal, behind = at - h * normal;
      return f(c, at.x(), at.y()) / ((f(c, ahead.x(), ahead.y()) - f(c, behind.x(), behind.y())) / (2 * h));
    });
    EXPECT_NEAR(spread[i], expected, 0.05 * expected) << i;
  }
}

TEST(FeatureSpread, OfAPointIsAnEllipse) {
  TrackedFeature point = test_support::pointMessage("tip", 50.0, 60.0);
  const Eigen::MatrixXd covariance = randomCovariance(2, 3.0, 5);
  point.covariance = numbers(covariance);
  const auto around = spreadAround(factOf(point));
  ASSERT_TRUE(around);
  EXPECT_LT((*around * around->transpose() - 4.0 * covariance).norm(), 1e-9) << "twice the standard deviations";
  EXPECT_TRUE(spreadAlong(factOf(point)).empty());
}

TEST(FeatureSpread, OfASplineIsItsExpectedError) {
  TrackedFeature spline = test_support::lineMessage();
  spline.kind = TrackedFeature::SPLINE;
  spline.expected_error = 0.7;
  EXPECT_EQ(spreadAlong(factOf(spline)), (std::vector<double>{0.7, 0.7}));
}

TEST(FeatureSpread, IsNotKnownWithoutACovariance) {
  TrackedFeature line = test_support::lineMessage(), point = test_support::pointMessage("tip", 5.0, 6.0);
  line.covariance[0] = std::numeric_limits<double>::infinity();
  point.covariance.clear();
  EXPECT_TRUE(spreadAlong(factOf(line)).empty());
  EXPECT_FALSE(spreadAround(factOf(point)));
  line = test_support::lineMessage();
  line.covariance = {-1.0, 0.0, 0.0, 0.0};
  EXPECT_TRUE(spreadAlong(factOf(line)).empty()) << "a covariance that is none";
  line.parameters = {1.0, 2.0, 3.0};
  line.covariance.assign(9, 0.0);
  EXPECT_TRUE(spreadAlong(factOf(line)).empty());
  TrackedFeature spline = test_support::lineMessage();
  spline.kind = TrackedFeature::SPLINE;
  spline.expected_error = std::numeric_limits<double>::infinity();
  EXPECT_TRUE(spreadAlong(factOf(spline)).empty());
}

}  // namespace
}  // namespace laparoscope_servo::screen
