#include "laparoscope_servo/features/line.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "unit/features/curve_check.h"

namespace laparoscope_servo::features {
namespace {

double distance(const Line& line, const Eigen::Vector2d& point, const Eigen::Vector2d& normal) {
  return (line.rho() - line.normal().dot(point)) / line.normal().dot(normal);
}

SiteFinding finding(const Site& site, bool seen) {
  return {site.point, site.point, seen ? 1.0 : 0.0, true, site.probe, site.slot};
}

TEST(Line, rhoAndThetaAreThoseOfTheSurvey) {
  const Line line({10.0, 20.0}, {110.0, 95.0});
  for (const Eigen::Vector2d& p : {line.begin(), line.end()}) {
    EXPECT_NEAR(p.x() * std::cos(line.theta()) + p.y() * std::sin(line.theta()) - line.rho(), 0.0, 1e-9);
  }
  // Downwards in the image, begin to end: the normal points to the right, along x.
  const Line down({50.0, 10.0}, {50.0, 110.0});
  EXPECT_NEAR(down.theta(), 0.0, 1e-12);
  EXPECT_NEAR(down.rho(), 50.0, 1e-12);
  const Line right({10.0, 40.0}, {110.0, 40.0});
  EXPECT_NEAR(right.theta(), -M_PI / 2.0, 1e-12);
  EXPECT_NEAR(right.rho(), -40.0, 1e-12);
  EXPECT_NEAR((right.end() - Eigen::Vector2d(110.0, 40.0)).norm(), 0.0, 1e-9);
}

TEST(Line, jacobiansAreThoseOfItsMotion) {
  for (const double x : {300.0, 30.0, -120.0}) expectJacobiansHold(Line({200.0, 20.0}, {x, 150.0}), distance);
  expectSitesAreInOrder(Line({20.0, 20.0}, {300.0, 150.0}), 4.0);
}

TEST(Line, probesLieBeyondItsEnds) {
  const Line line({20.0, 20.0}, {120.0, 20.0});
  std::vector<Site> sites;
  line.sites(4.0, 200, sites);
  for (const Site& site : sites) EXPECT_EQ(site.probe, site.point.x() < 20.0 || site.point.x() > 120.0);
  EXPECT_TRUE(sites.front().probe);
  EXPECT_TRUE(sites.back().probe);
}

TEST(Line, isCarriedByAHomography) {
  Line line({20.0, 20.0}, {120.0, 60.0});
  Eigen::Matrix3d motion;
  motion << 1.02, -0.1, 7.0, 0.11, 0.97, -3.0, 1e-4, -2e-4, 1.0;
  const Eigen::Vector3d b = motion * line.begin().homogeneous(), e = motion * line.end().homogeneous();
  line.transform(motion);
  EXPECT_NEAR((line.begin() - b.hnormalized()).norm(), 0.0, 1e-9);
  EXPECT_NEAR((line.end() - e.hnormalized()).norm(), 0.0, 1e-9);
}

TEST(Line, covarianceIsThatOfRhoAndTheta) {
  const Line line({20.0, 220.0}, {180.0, 60.0});
  Eigen::Matrix2d of_parameters;
  of_parameters << 0.04, 0.01, 0.01, 0.09;
  Eigen::Matrix2d derivative;
  for (int k = 0; k < 2; ++k) {
    Line more = line, less = line;
    Eigen::VectorXd step = Eigen::VectorXd::Zero(2);
    step[k] = 1e-4;
    more.move(step);
    less.move(-step);
    derivative.col(k) << (more.rho() - less.rho()) / 2e-4, (more.theta() - less.theta()) / 2e-4;
  }
  const Eigen::Matrix2d expected = derivative * of_parameters * derivative.transpose();
  EXPECT_NEAR((line.covariance(of_parameters) - expected).norm(), 0.0, 1e-6 * expected.norm());
}

// Its ends are where it is seen to end; what is covered is searched for a while.
TEST(Line, findsItsEnds) {
  Line line({20.0, 20.0}, {220.0, 20.0});
  const Eigen::Matrix2d covariance = Eigen::Matrix2d::Identity();
  std::vector<Site> sites;
  const auto see = [&](double from, double to, double passed) {
    line.sites(4.0, 200, sites);
    std::vector<SiteFinding> findings;
    for (const Site& site : sites) findings.push_back(finding(site, site.point.x() > from && site.point.x() < to));
    line.settle(findings, covariance, passed);
  };
  see(60.0, 220.0, 0.04);
  EXPECT_NEAR(line.begin().x(), 60.0, 4.0);
  EXPECT_NEAR(line.end().x(), 220.0, 4.0);
  line.sites(4.0, 200, sites);
  EXPECT_LT(sites[4].point.x(), 30.0);  // the first one that is no probe: still searched
  see(20.0, 220.0, 0.04);
  EXPECT_NEAR(line.begin().x(), 20.0, 4.0);
  for (int k = 0; k < 300; ++k) see(60.0, 220.0, 0.04);
  line.sites(4.0, 200, sites);
  EXPECT_GT(sites[4].point.x(), 55.0);
  for (int k = 0; k < 20; ++k) see(0.0, 400.0, 0.04);  // it grows where there is more of it
  EXPECT_LT(line.begin().x(), 10.0);
  EXPECT_GT(line.end().x(), 300.0);
  const double length = line.length();
  see(1000.0, 2000.0, 0.04);  // nothing is seen
  EXPECT_EQ(line.length(), length);
}

TEST(Line, refusesWhatIsNoLine) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(Line({10.0, 10.0}, {10.0, 10.0}), std::invalid_argument);
  EXPECT_THROW(Line({10.0, 10.0}, {10.0, 39.0}), std::invalid_argument);
  EXPECT_THROW(Line({nan, 10.0}, {100.0, 39.0}), std::invalid_argument);
  EXPECT_THROW(Line({0.0, 10.0}, {std::numeric_limits<double>::infinity(), 39.0}), std::invalid_argument);
  try {
    Line({10.0, 10.0}, {12.5, 10.0});
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("(12.5, 10), expected"), std::string::npos) << error.what();
  }
}

TEST(Line, oneThatIsNotFiniteHasNoSites) {
  Eigen::Matrix3d nowhere = Eigen::Matrix3d::Identity();
  nowhere(0, 2) = std::numeric_limits<double>::quiet_NaN();
  Line line({10.0, 10.0}, {100.0, 39.0});
  line.transform(nowhere);
  EXPECT_FALSE(line.isSound());
  std::vector<Site> sites(3);
  line.sites(4.0, 50, sites);
  EXPECT_TRUE(sites.empty());
}

}  // namespace
}  // namespace laparoscope_servo::features
