#include "laparoscope_servo/features/ellipse.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "unit/features/curve_check.h"

namespace laparoscope_servo::features {
namespace {

// Of the survey's equation at a point; 0 on the ellipse.
double equation(const EllipseCoefficients& k, const Eigen::Vector2d& p) {
  return p.x() * p.x() + k[0] * p.y() * p.y() + 2.0 * k[1] * p.x() * p.y() + 2.0 * k[2] * p.x() + 2.0 * k[3] * p.y() +
         k[4];
}

double distance(const Ellipse& ellipse, const Eigen::Vector2d& point, const Eigen::Vector2d& normal) {
  const EllipseCoefficients k = ellipse.coefficients();
  double d = 0.0;
  for (int i = 0; i < 5; ++i) {
    const double here = equation(k, point + d * normal), next = equation(k, point + (d + 1e-4) * normal);
    d -= 1e-4 * here / (next - here);
  }
  return d;
}

TEST(Ellipse, coefficientsAreThoseOfTheSurvey) {
  const Ellipse ellipse({120.0, 90.0}, 60.0, 35.0, 0.4);
  const EllipseCoefficients k = ellipse.coefficients();
  for (double phi = 0.0; phi < 6.2; phi += 0.5) EXPECT_NEAR(equation(k, ellipse.at(phi)), 0.0, 1e-7);
  EXPECT_LT(k[1] * k[1], k[0]);
  // A circle about (u, v): x^2 + y^2 - 2 u x - 2 v y + u^2 + v^2 - r^2 = 0.
  const EllipseCoefficients circle = Ellipse({10.0, 20.0}, 5.0, 5.0, 0.3).coefficients();
  EXPECT_NEAR((circle - (EllipseCoefficients() << 1.0, 0.0, -10.0, -20.0, 475.0).finished()).norm(), 0.0, 1e-9);
}

TEST(Ellipse, isTheOneOfItsCoefficientsAndOfItsPoints) {
  for (const double angle : {-1.5, -0.3, 0.0, 1.1}) {
    const Ellipse ellipse({120.0, 90.0}, 60.0, 35.0, angle);
    std::vector<Eigen::Vector2d> points;
    for (double phi = 0.0; phi < 6.2; phi += 0.9) points.push_back(ellipse.at(phi));
    for (const Ellipse& same : {Ellipse::fromCoefficients(ellipse.coefficients()), Ellipse::throughPoints(points)}) {
      EXPECT_NEAR((same.centre() - ellipse.centre()).norm(), 0.0, 1e-6);
      EXPECT_NEAR(same.majorRadius(), 60.0, 1e-6);
      EXPECT_NEAR(same.minorRadius(), 35.0, 1e-6);
      EXPECT_NEAR(same.angle(), angle, 1e-6);
    }
  }
}

TEST(Ellipse, jacobiansAreThoseOfItsMotion) {
  expectJacobiansHold(Ellipse({120.0, 90.0}, 60.0, 35.0, 0.4), distance);
  expectJacobiansHold(Ellipse({20.0, -90.0}, 50.0, 50.0, 0.0), distance);
  expectSitesAreInOrder(Ellipse({120.0, 90.0}, 60.0, 35.0, 0.4), 4.0);
}

TEST(Ellipse, normalsPointOutwardsAndCurvatureIsThatOfACircle) {
  std::vector<Site> sites;
  Ellipse({120.0, 90.0}, 50.0, 50.0, 0.0).sites(4.0, 500, sites);
  for (const Site& site : sites) {
    EXPECT_NEAR((site.normal - (site.point - Eigen::Vector2d(120.0, 90.0)) / 50.0).norm(), 0.0, 1e-9);
    EXPECT_NEAR(site.curvature, 0.02, 1e-9);
  }
}

TEST(Ellipse, sitesAreEvenlySpacedAndKeepToTheArc) {
  Ellipse ellipse({120.0, 90.0}, 80.0, 20.0, 0.0);
  std::vector<Site> sites;
  ellipse.sites(4.0, 500, sites);
  const double step = (sites[1].point - sites[0].point).norm();
  for (std::size_t i = 1; i < sites.size(); ++i) {
    EXPECT_NEAR((sites[i].point - sites[i - 1].point).norm(), step, 0.3 * step);
  }
  ellipse.setArc(0.0, M_PI);  // from the right over the bottom of the image to the left
  ellipse.sites(4.0, 500, sites);
  for (const Site& site : sites) EXPECT_GT(site.point.y(), 90.0);
}

TEST(Ellipse, isCarriedByAHomography) {
  Ellipse ellipse({120.0, 90.0}, 60.0, 35.0, 0.4), before = ellipse;
  Eigen::Matrix3d motion;
  motion << 1.02, -0.1, 7.0, 0.11, 0.97, -3.0, 1e-4, -2e-4, 1.0;
  ellipse.transform(motion);
  for (double phi = 0.0; phi < 6.2; phi += 0.5) {
    const Eigen::Vector3d p = motion * before.at(phi).homogeneous();
    EXPECT_NEAR(distance(ellipse, p.hnormalized(), Eigen::Vector2d::UnitX()), 0.0, 1e-4);
  }
  Eigen::Matrix3d through_infinity = Eigen::Matrix3d::Identity();
  through_infinity(2, 0) = -1.0 / 120.0;
  ellipse.transform(through_infinity);
  EXPECT_FALSE(ellipse.isSound());
}

TEST(Ellipse, changeIsTheLargestStretch) {
  const Ellipse a({120.0, 90.0}, 60.0, 35.0, 0.4);
  EXPECT_NEAR(Ellipse({10.0, 30.0}, 60.0, 35.0, 0.4).change(a), 1.0, 1e-9);
  EXPECT_NEAR(Ellipse({10.0, 30.0}, 66.0, 35.0, 0.4).change(a), 1.1, 1e-9);
  EXPECT_NEAR(Ellipse({10.0, 30.0}, 60.0, 28.0, 0.4).change(a), 1.25, 1e-9);
}

TEST(Ellipse, covarianceIsThatOfTheCoefficients) {
  // To first order, coefficients move as the covariance's square root says.
  const Ellipse ellipse({12.0, 9.0}, 60.0, 35.0, 0.4);
  Eigen::VectorXd step(5);
  step << 0.01, -0.02, 0.015, 0.01, -0.005;
  Ellipse moved = ellipse;
  moved.move(step);
  const EllipseCoefficients change = moved.coefficients() - ellipse.coefficients();
  const Eigen::MatrixXd covariance = ellipse.covariance(step * step.transpose());
  EXPECT_NEAR((covariance - change * change.transpose()).norm(), 0.0, 0.02 * covariance.norm());
}

TEST(Ellipse, refusesWhatIsNone) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(Ellipse({nan, 0.0}, 20.0, 20.0, 0.0), std::invalid_argument);
  EXPECT_THROW(Ellipse({0.0, 0.0}, 0.0, 20.0, 0.0), std::invalid_argument);
  EXPECT_THROW(Ellipse({0.0, 0.0}, 20.0, nan, 0.0), std::invalid_argument);
  EXPECT_THROW(Ellipse({0.0, 0.0}, 20.0, 20.0, nan), std::invalid_argument);
  EllipseCoefficients hyperbola;
  hyperbola << -1.0, 0.0, 0.0, 0.0, -400.0;
  EXPECT_THROW(Ellipse::fromCoefficients(hyperbola), std::invalid_argument);
  EXPECT_THROW(Ellipse::throughPoints({{0, 0}, {1, 1}, {2, 2}, {3, 3}}), std::invalid_argument);
  EXPECT_THROW(Ellipse::throughPoints({{0, 0}, {10, 10}, {20, 20}, {30, 30}, {40, 40}}), std::invalid_argument);
  Ellipse ellipse({0.0, 0.0}, 20.0, 20.0, 0.0);
  for (const double extent : {0.0, 7.0, nan}) EXPECT_THROW(ellipse.setArc(0.0, extent), std::invalid_argument);
}

}  // namespace
}  // namespace laparoscope_servo::features
