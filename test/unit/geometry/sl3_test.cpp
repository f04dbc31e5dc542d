#include "laparoscope_servo/geometry/sl3.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>
#include <vector>

namespace laparoscope_servo::geometry {
namespace {

Eigen::Matrix3d unit(int row, int column) {
  Eigen::Matrix3d m = Eigen::Matrix3d::Zero();
  m(row, column) = 1.0;
  return m;
}

// Zero, tiny, each generator, ordinary and large elements; with rotations by nearly half a turn.
std::vector<Vector8d> elements() {
  std::vector<Vector8d> all{Vector8d::Zero()};
  for (int k = 0; k < 8; ++k) {
    for (const double size : {1e-300, 1e-12, -1e-3, 0.5, -2.0}) {
      Vector8d x = Vector8d::Zero();
      x[k] = size;
      all.push_back(x);
    }
  }
  Vector8d turn = Vector8d::Zero();
  turn[2] = -3.0;
  turn[3] = 3.0;
  all.push_back(turn);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (int n = 0; n < 50; ++n) {
    Vector8d x;
    for (int k = 0; k < 8; ++k) x[k] = (n % 2 == 0 ? 0.1 : 1.0) * uniform(random);
    all.push_back(x);
  }
  return all;
}

TEST(Sl3, GeneratorsStandInTheirOrder) {
  const Eigen::Matrix3d expected[] = {
      unit(0, 2), unit(1, 2), unit(0, 1), unit(1, 0), unit(0, 0) - unit(1, 1), unit(2, 2) - unit(1, 1),
      unit(2, 0), unit(2, 1)};
  for (int k = 0; k < 8; ++k) {
    Vector8d x = Vector8d::Zero();
    x[k] = 1.0;
    EXPECT_EQ(sl3Hat(x), expected[k]) << k;
  }
}

TEST(Sl3, HatHasNoTraceAndVeeUndoesIt) {
  for (const Vector8d& x : elements()) {
    EXPECT_NEAR(sl3Hat(x).trace(), 0.0, 1e-15);
    EXPECT_NEAR((sl3Vee(sl3Hat(x)) - x).norm(), 0.0, 1e-14);
    EXPECT_NEAR((sl3Vee(sl3Hat(x) + 3.0 * Eigen::Matrix3d::Identity()) - x).norm(), 0.0, 1e-14);
  }
}

TEST(Sl3, ExponentialHasDeterminantOne) {
  for (const Vector8d& x : elements()) EXPECT_NEAR(sl3Exp(x).determinant(), 1.0, 1e-12);
}

TEST(Sl3, ExponentialOfTheOppositeIsTheInverse) {
  for (const Vector8d& x : elements()) {
    EXPECT_NEAR((sl3Exp(x) * sl3Exp(-x) - Eigen::Matrix3d::Identity()).norm(), 0.0, 1e-12);
  }
}

TEST(Sl3, OneParameterSubgroupsAddUp) {
  for (const Vector8d& x : elements()) {
    EXPECT_NEAR((sl3Exp(0.3 * x) * sl3Exp(0.7 * x) - sl3Exp(x)).norm(), 0.0, 1e-12 * sl3Exp(x).norm());
  }
}

TEST(Sl3, DerivativeAtZeroIsHat) {
  const double step = 1e-6;
  for (int k = 0; k < 8; ++k) {
    Vector8d x = Vector8d::Zero();
    x[k] = step;
    const Eigen::Matrix3d rate = (sl3Exp(x) - sl3Exp(-x)) / (2.0 * step);
    EXPECT_NEAR((rate - sl3Hat(x / step)).norm(), 0.0, 1e-9);
  }
}

TEST(Sl3, LogarithmUndoesTheExponentialNearTheIdentity) {
  for (const Vector8d& x : elements()) {
    if (x.norm() < 1.5) {
      EXPECT_NEAR((sl3Log(sl3Exp(x)) - x).norm(), 0.0, 1e-10) << x.transpose();
    }
  }
  EXPECT_EQ(sl3Log(Eigen::Matrix3d::Identity()), Vector8d::Zero());
}

TEST(Sl3, ExponentialUndoesTheLogarithmFarFromTheIdentity) {
  int far = 0;
  for (const Vector8d& x : elements()) {
    const Eigen::Matrix3d g = sl3Exp(x);
    if ((g - Eigen::Matrix3d::Identity()).norm() > 1.0) ++far;
    EXPECT_NEAR((sl3Exp(sl3Log(g)) - g).norm(), 0.0, 1e-11 * g.norm()) << x.transpose();
  }
  EXPECT_GT(far, 10);
}

TEST(Sl3, LogarithmOfWhatHasNoneIsNotFinite) {
  EXPECT_FALSE(sl3Log(Eigen::Vector3d(-1.0, -2.0, 0.5).asDiagonal()).allFinite());
  EXPECT_FALSE(sl3Log(Eigen::Matrix3d::Zero()).allFinite());
  EXPECT_FALSE(sl3Log(Eigen::Matrix3d::Constant(std::numeric_limits<double>::quiet_NaN())).allFinite());
  EXPECT_FALSE(sl3Log(Eigen::Matrix3d::Constant(std::numeric_limits<double>::infinity())).allFinite());
}

// x[0] and x[1] shift along u and v: what the order of the generators means in an image.
TEST(Sl3, FirstTwoCoordinatesAreTranslations) {
  Vector8d x = Vector8d::Zero();
  x[0] = 0.25;
  x[1] = -0.5;
  const Eigen::Vector3d p = sl3Exp(x) * Eigen::Vector3d(1.0, 2.0, 1.0);
  EXPECT_TRUE(p.isApprox(Eigen::Vector3d(1.25, 1.5, 1.0), 1e-14));
}

TEST(Sl3, ExponentialOfWhatIsNotFiniteIsNotFinite) {
  Vector8d x = Vector8d::Zero();
  x[3] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(sl3Exp(x).allFinite());
  x[3] = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(sl3Exp(x).allFinite());
}

TEST(NormaliseDeterminant, GivesDeterminantOneAndTheSameHomography) {
  Eigen::Matrix3d g;
  g << 2, 0.1, 30, -0.2, 1.5, 4, 0.001, 0.002, 1;
  for (const double scale : {1.0, -1.0, 1e-60, 1e60, -7.0}) {
    const Eigen::Matrix3d normalised = normaliseDeterminant(scale * g);
    EXPECT_NEAR(normalised.determinant(), 1.0, 1e-12) << scale;
    EXPECT_TRUE(normalised.isApprox(normaliseDeterminant(g), 1e-12)) << scale;
  }
}

TEST(NormaliseDeterminant, RefusesWhatIsNoHomography) {
  Eigen::Matrix3d nan = Eigen::Matrix3d::Identity();
  nan(1, 2) = std::numeric_limits<double>::quiet_NaN();
  Eigen::Matrix3d infinite = Eigen::Matrix3d::Identity();
  infinite(0, 0) = std::numeric_limits<double>::infinity();
  Eigen::Matrix3d flat = Eigen::Matrix3d::Identity();
  flat(2, 2) = 0.0;
  for (const Eigen::Matrix3d& bad : {nan, infinite, flat, Eigen::Matrix3d(Eigen::Matrix3d::Zero())}) {
    try {
      normaliseDeterminant(bad);
      ADD_FAILURE() << "no error for\n" << bad;
    } catch (const std::invalid_argument& error) {
      EXPECT_NE(std::string(error.what()).find("determinant"), std::string::npos) << error.what();
    }
  }
}

class Sl3StepsTest : public ::testing::Test {
 protected:
  Sl3StepsTest() {
    Eigen::Matrix3d n;
    n << 0.02, 0.0, -3.0, 0.0, 0.02, -2.0, 0.0, 0.0, 1.0;  // 100 px about (150, 100)
    steps_ = Sl3Steps(n);
    g_ = normaliseDeterminant(n.inverse() * sl3Exp(0.1 * Vector8d::LinSpaced(-1.0, 1.0)) * n);
  }
  Sl3Steps steps_;
  Eigen::Matrix3d g_;
};

TEST_F(Sl3StepsTest, MinusUndoesPlusAndNothingIsNoStep) {
  EXPECT_TRUE(steps_.plus(g_, Vector8d::Zero()).isApprox(g_, 1e-14));
  EXPECT_LT(steps_.minus(g_, g_).norm(), 1e-12);
  for (const Vector8d& x : elements()) {
    if (x.norm() > 1.5) continue;  // further, the logarithm need not be the principal one
    const Eigen::Matrix3d there = steps_.plus(g_, x);
    EXPECT_NEAR(there.determinant(), 1.0, 1e-9);
    EXPECT_LT((steps_.minus(there, g_) - x).norm(), 1e-9 * (1.0 + x.norm())) << x.transpose();
    EXPECT_LT((steps_.minus(-3.0 * there, g_) - x).norm(), 1e-9 * (1.0 + x.norm())) << "up to scale";
  }
}

// The first two directions are shifts: in N's coordinates by x, in the homography's own by x over N's scale.
TEST_F(Sl3StepsTest, CountsInTheUnitsOfTheNormalisation) {
  Vector8d x = Vector8d::Zero();
  x[0] = 0.1;
  const Eigen::Matrix3d moved = steps_.plus(Eigen::Matrix3d::Identity(), x);
  EXPECT_NEAR(moved(0, 2) / moved(2, 2), 0.1 / 0.02, 1e-9);
}

TEST_F(Sl3StepsTest, KeepsWhatIsNotFinite) {
  const Vector8d bad = Vector8d::Constant(std::numeric_limits<double>::quiet_NaN());
  EXPECT_FALSE(steps_.plus(g_, bad).allFinite());
  EXPECT_THROW(steps_.minus(g_, Eigen::Matrix3d::Zero()), std::invalid_argument);
}

}  // namespace
}  // namespace laparoscope_servo::geometry
