#include "laparoscope_servo/geometry/se3.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace laparoscope_servo::geometry {
namespace {

Vector6d twist(const Eigen::Vector3d& v, const Eigen::Vector3d& w) {
  Vector6d t;
  t << v, w;
  return t;
}

// Zero, tiny, on both sides of the series' threshold, ordinary, exactly pi, beyond.
std::vector<Vector6d> twists() {
  const Eigen::Vector3d axis = Eigen::Vector3d(1.0, -2.0, 0.5).normalized();
  std::vector<Vector6d> all;
  for (const double angle : {0.0, 1e-300, 1e-12, 0.99e-4, 1.01e-4, 1e-2, 1.0, 3.0, M_PI, 4.0, 20.0}) {
    for (const Eigen::Vector3d& direction :
         {axis, Eigen::Vector3d(Eigen::Vector3d::UnitX()), Eigen::Vector3d(-Eigen::Vector3d::UnitZ())}) {
      all.push_back(twist({0.3, -0.2, 0.1}, angle * direction));
      all.push_back(twist(Eigen::Vector3d::Zero(), angle * direction));
    }
  }
  return all;
}

TEST(Skew, IsTheCrossProduct) {
  const Eigen::Vector3d w(0.1, -2.0, 3.0);
  const Eigen::Vector3d u(4.0, 5.0, -6.0);
  EXPECT_TRUE((skew(w) * u).isApprox(w.cross(u), 1e-15));
  EXPECT_EQ(vee(skew(w)), w);
}

TEST(Vee, IgnoresTheSymmetricPart) {
  const Eigen::Vector3d w(0.1, -2.0, 3.0);
  Eigen::Matrix3d symmetric;
  symmetric << 1, 2, 3, 2, 5, 6, 3, 6, 9;
  EXPECT_TRUE(vee(skew(w) + symmetric).isApprox(w, 1e-14));
}

TEST(So3, PositiveTurnsAreRightHanded) {
  EXPECT_TRUE((so3Exp({0, 0, M_PI / 2}) * Eigen::Vector3d::UnitX()).isApprox(Eigen::Vector3d::UnitY(), 1e-15));
  EXPECT_TRUE((so3Exp({M_PI / 2, 0, 0}) * Eigen::Vector3d::UnitY()).isApprox(Eigen::Vector3d::UnitZ(), 1e-15));
}

TEST(So3, ExponentialsAreRotations) {
  for (const Vector6d& t : twists()) {
    const Eigen::Matrix3d r = so3Exp(t.tail<3>());
    EXPECT_TRUE((r * r.transpose()).isApprox(Eigen::Matrix3d::Identity(), 1e-14));
    EXPECT_NEAR(r.determinant(), 1.0, 1e-14);
  }
}

TEST(So3, TheNearestRotationOfARotationIsItselfAlsoWhenItIsScaledOrDisturbed) {
  const Eigen::Matrix3d r = so3Exp({0.3, -1.2, 2.0});
  Eigen::Matrix3d symmetric;
  symmetric << 0.1, 0.02, -0.03, 0.02, -0.2, 0.05, -0.03, 0.05, 0.15;
  EXPECT_TRUE(nearestRotation(2.5 * r).isApprox(r, 1e-14));
  EXPECT_TRUE(nearestRotation(r * (Eigen::Matrix3d::Identity() + symmetric)).isApprox(r, 1e-14));
}

TEST(So3, TheNearestRotationOfAReflectionIsARotation) {
  const Eigen::Vector3d axis = Eigen::Vector3d(1.0, 2.0, -0.5).normalized();
  const Eigen::Matrix3d reflection = Eigen::Matrix3d::Identity() - 2.2 * axis * axis.transpose();
  const Eigen::Matrix3d r = nearestRotation(reflection);
  EXPECT_NEAR(r.determinant(), 1.0, 1e-14);
  EXPECT_TRUE((r * r.transpose()).isApprox(Eigen::Matrix3d::Identity(), 1e-14));
}

TEST(So3, AnglesBetweenVectorsAreExactFromTheSmallestToAHalfTurn) {
  const Eigen::Vector3d a(0.2, -0.4, 3.0), across = a.unitOrthogonal();
  for (const double angle : {0.0, 1e-12, 1e-6, 0.3, 1.5, 3.0, M_PI}) {
    const Eigen::Vector3d b = so3Exp(angle * across) * a;
    EXPECT_NEAR(angleBetween(a, 0.1 * b), angle, 1e-15 + 1e-14 * angle) << angle;
    EXPECT_EQ(angleBetween(a, b), angleBetween(b, a));
  }
  EXPECT_EQ(angleBetween(a, Eigen::Vector3d::Zero()), 0.0);
}

TEST(So3, LogarithmUndoesTheExponential) {
  for (const Vector6d& t : twists()) {
    const Eigen::Vector3d w = t.tail<3>();
    const Eigen::Vector3d log = so3Log(so3Exp(w));
    EXPECT_LE(log.norm(), M_PI + 1e-12);
    EXPECT_TRUE(so3Exp(log).isApprox(so3Exp(w), 1e-12));
    if (w.norm() < 3.1) {
      EXPECT_NEAR((log - w).norm(), 0.0, 1e-12);
    }
  }
}

TEST(Se3, ExponentialSolvesTheDifferentialEquation) {
  for (const Vector6d& t : twists()) {
    const double step = 1e-6;
    for (const double time : {0.0, 0.4, 1.0}) {
      const Eigen::Matrix4d here = se3Exp(time * t).matrix();
      const Eigen::Matrix4d rate =
          (se3Exp((time + step) * t).matrix() - se3Exp((time - step) * t).matrix()) / (2.0 * step);
      Eigen::Matrix4d hat = Eigen::Matrix4d::Zero();
      hat.topLeftCorner<3, 3>() = skew(t.tail<3>());
      hat.topRightCorner<3, 1>() = t.head<3>();
      EXPECT_LT((rate - here * hat).norm(), 1e-7 * (1.0 + t.squaredNorm()));
    }
  }
}

TEST(Se3, MotionsAboutOneAxisAddUp) {
  for (const Vector6d& t : twists()) {
    EXPECT_TRUE((se3Exp(0.3 * t) * se3Exp(0.7 * t)).isApprox(se3Exp(t), 1e-12));
    EXPECT_TRUE((se3Exp(t) * se3Exp(-t)).isApprox(Eigen::Isometry3d::Identity(), 1e-12));
  }
}

// The series and the closed form meet.
TEST(Se3, IsContinuousWhereTheSeriesEnds) {
  const Eigen::Vector3d v(0.3, -0.2, 0.1);
  const Eigen::Vector3d axis = Eigen::Vector3d(1.0, -2.0, 0.5).normalized();
  const Eigen::Isometry3d below = se3Exp(twist(v, 0.9999999e-4 * axis));
  const Eigen::Isometry3d above = se3Exp(twist(v, 1.0000001e-4 * axis));
  EXPECT_LT((below.matrix() - above.matrix()).norm(), 1e-10);
}

// A frame b that turns about z, seen from a frame a that is ahead of it on x: a's origin moves to +y.
TEST(TwistTransform, PinsTheConvention) {
  const Eigen::Isometry3d a_T_b(Eigen::Translation3d(-1.0, 0.0, 0.0));
  const Vector6d there = twistTransform(a_T_b) * twist(Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitZ());
  EXPECT_TRUE(there.isApprox(twist({0, 1, 0}, {0, 0, 1}), 1e-15));
}

TEST(TwistTransform, IsTheVelocityOfTheSameBody) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (int k = 0; k < 50; ++k) {
    Vector6d body;
    Vector6d place;
    for (int i = 0; i < 6; ++i) {
      body[i] = uniform(random);
      place[i] = 2.0 * uniform(random);
    }
    const Eigen::Isometry3d a_T_b = se3Exp(place);
    // Moving b by its twist moves a by the transformed one: a_T_b exp(t) b_T_a = exp(Ad t).
    const Eigen::Isometry3d expected = a_T_b * se3Exp(body) * a_T_b.inverse();
    EXPECT_TRUE(se3Exp(twistTransform(a_T_b) * body).isApprox(expected, 1e-12));
  }
}

TEST(TwistTransform, IsAHomomorphism) {
  const Eigen::Isometry3d a = se3Exp(twist({0.1, 0.2, 0.3}, {1.0, -0.5, 0.2}));
  const Eigen::Isometry3d b = se3Exp(twist({-0.3, 0.1, 0.0}, {0.3, 2.0, -1.0}));
  EXPECT_TRUE((twistTransform(a) * twistTransform(b)).isApprox(twistTransform(a * b), 1e-12));
  EXPECT_TRUE((twistTransform(a) * twistTransform(a.inverse())).isApprox(Matrix6d::Identity(), 1e-12));
}

}  // namespace
}  // namespace laparoscope_servo::geometry
