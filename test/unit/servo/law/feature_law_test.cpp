#include "servo/law/feature_law.h"

#include <gtest/gtest.h>

#include <random>

#include "unit/servo/plane_loop.h"

namespace laparoscope_servo::servo {
namespace {

using test::kD2;
using test::kZ;
using test::PlaneLoop;
using test::sizeOf;
using test::straight;

const Eigen::Matrix3d kOblique = scope::obliqueOptics(30.0 * M_PI / 180.0, 0.4);

Eigen::Vector4d features(const TaskError& error) {
  return {error.x, error.y, error.log_depth, error.alpha};
}

// The interaction matrix against the loop's own numeric derivative, for both optics and places all over the image.
TEST(FeatureJacobian, IsTheDerivativeOfTheFeatures) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (const Eigen::Matrix3d& optics : {Eigen::Matrix3d(Eigen::Matrix3d::Identity()), kOblique}) {
    for (int k = 0; k < 50; ++k) {
      PlaneLoop loop(Eigen::Vector3d::UnitZ(), kZ, {optics, kD2});
      // The law takes the ROI for one that faces the camera: only shifted and brought nearer it does.
      const TaskError at = loop.error();
      const Eigen::Matrix4d j = featureJacobian(at.x, at.y, kZ, loop.scope());
      const Eigen::Vector4d direction(uniform(random), uniform(random), uniform(random), 0.1 * uniform(random));
      PlaneLoop ahead = loop, behind = loop;
      ahead.move(scope::Velocity::fromVector(direction), 1e-4);
      behind.move(scope::Velocity::fromVector(direction), -1e-4);
      const Eigen::Vector4d numeric = (features(ahead.error()) - features(behind.error())) / 2e-4;
      EXPECT_LT((numeric - j * direction).norm(), 0.02 * numeric.norm()) << numeric.transpose() << "\n"
                                                                         << (j * direction).transpose();
    }
  }
}

TEST(FeatureLaw, IsZeroAtTheReference) {
  for (const Eigen::Matrix3d& optics : {Eigen::Matrix3d(Eigen::Matrix3d::Identity()), kOblique}) {
    const PlaneLoop loop(Eigen::Vector3d::UnitZ(), kZ, {optics, kD2});
    EXPECT_NEAR(FeatureLaw(FeatureGains()).velocity(loop.error(), loop.scope()).sum().vector().norm(), 0.0, 1e-12);
  }
}

// Each motion alone is answered by its opposite, with the rate of its feature.
TEST(FeatureLaw, DrivesEachMotionBackAtItsRate) {
  FeatureGains gains;
  gains.centre = 3.0;
  gains.depth = 2.0;
  gains.orientation = 4.0;
  const double rates[] = {gains.centre, gains.centre, gains.orientation, gains.depth};
  for (int axis = 0; axis < 4; ++axis) {
    for (const double sign : {1.0, -1.0}) {
      Eigen::Vector4d displacement = Eigen::Vector4d::Zero();
      displacement[axis] = sign * 1e-4;
      PlaneLoop loop(Eigen::Vector3d::UnitZ(), kZ, straight());
      loop.offset(scope::Velocity::fromVector(displacement));
      const Eigen::Vector4d answer = FeatureLaw(gains).velocity(loop.error(), loop.scope()).sum().vector();
      EXPECT_NEAR(-answer[axis] / displacement[axis], rates[axis], 0.02) << "axis " << axis;
    }
  }
}

// What the features' decoupling is for: the ROI's centre goes straight to its goal.
TEST(FeatureLaw, TakesTheCentreStraight) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const FeatureLaw law{FeatureGains()};
  for (int start = 0; start < 20;) {
    PlaneLoop loop(Eigen::Vector3d::UnitZ(), kZ, straight());
    loop.offset({0.2 * uniform(random), 0.2 * uniform(random), 0.5 * uniform(random), 0.01 * uniform(random)});
    if (!loop.visible()) continue;
    ++start;
    const TaskError first = loop.error();
    const Eigen::Vector2d goal(first.desired_x, first.desired_y);
    const Eigen::Vector2d way = Eigen::Vector2d(first.x, first.y) - goal;
    for (int k = 0; k < 200; ++k) {
      loop.move(law.velocity(loop.error(), loop.scope()).sum(), 0.005);
      const Eigen::Vector2d left = Eigen::Vector2d(loop.error().x, loop.error().y) - goal;
      EXPECT_LT(std::abs(way.x() * left.y() - way.y() * left.x()) / way.norm(), 0.06 * way.norm() + 1e-6);
    }
  }
}

TEST(FeatureLaw, DoesNotDependOnTheScaleOfTheHomographyOrOnFullTurns) {
  PlaneLoop loop(Eigen::Vector3d::UnitZ(), kZ, straight());
  loop.offset({0.1, -0.05, 0.3, 0.01});
  const FeatureLaw law{FeatureGains()};
  const Eigen::Vector4d expected = law.velocity(loop.error(), loop.scope()).sum().vector();
  for (const double scale : {-3.0, 0.1, 7.0}) {
    const TaskError error = taskError(scale * loop.homography(), test::kRoi, test::kCamera);
    EXPECT_NEAR((law.velocity(error, loop.scope()).sum().vector() - expected).norm(), 0.0, 1e-12);
  }
  TaskError turned = loop.error();
  turned.alpha += 2.0 * M_PI;
  EXPECT_NEAR((law.velocity(turned, loop.scope()).sum().vector() - expected).norm(), 0.0, 1e-12);
}

TEST(FeatureLaw, ATurnOfAboutHalfARoundIsLeftAsItIs) {
  for (const double turn : {-3.4, -3.0, 0.0, 0.1, 3.0, 3.2, 3.4}) EXPECT_EQ(shortTurn(turn), turn);
  for (const double turn : {-6.0, -4.0, 4.0, 6.0, 10.0, 100.0}) {
    EXPECT_LE(std::abs(shortTurn(turn)), M_PI);
    EXPECT_NEAR(std::sin(shortTurn(turn)), std::sin(turn), 1e-12);
    EXPECT_NEAR(std::cos(shortTurn(turn)), std::cos(turn), 1e-12);
  }
}

// Random visible planes and starts, d2 and Z* wrong by up to two, straight and oblique optics.
TEST(FeatureLaw, ConvergesFromRandomVisibleStarts) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (const Eigen::Matrix3d& optics : {Eigen::Matrix3d(Eigen::Matrix3d::Identity()), kOblique}) {
    for (int start = 0; start < 200;) {
      FeatureGains gains;
      gains.desired_depth = kZ * std::pow(2.0, uniform(random));
      const FeatureLaw law(gains);
      const double wrong = std::pow(2.0, uniform(random));
      const Eigen::Vector3d normal = Eigen::Vector3d(0.2 * uniform(random), 0.2 * uniform(random), 1.0).normalized();
      PlaneLoop loop(normal, kZ, {optics, kD2});
      loop.offset({0.25 * uniform(random), 0.25 * uniform(random), 0.7 * uniform(random), 0.03 * uniform(random)});
      if (!loop.visible()) continue;
      ++start;
      for (int k = 0; k < 400; ++k) {
        const scope::Geometry believed{optics, wrong * loop.scope().d2};
        loop.move(law.velocity(loop.error(), believed).sum(), 0.01);
      }
      EXPECT_LT(sizeOf(loop.error()), 1e-3)
          << "start " << start << ", d2 " << wrong << ", Z* " << gains.desired_depth / kZ;
    }
  }
}

TEST(FeatureLaw, ReleasedItDoesNotSpinAndStillCentres) {
  const FeatureLaw law(FeatureGains(), LawAxes{false, true});
  for (const Eigen::Matrix3d& optics : {Eigen::Matrix3d(Eigen::Matrix3d::Identity()), kOblique}) {
    PlaneLoop loop(Eigen::Vector3d::UnitZ(), kZ, {optics, kD2});
    loop.offset({0.1, -0.1, 0.3, 0.01});
    for (int k = 0; k < 400; ++k) {
      const scope::Velocity velocity = law.velocity(loop.error(), loop.scope()).sum();
      EXPECT_EQ(velocity.spin, 0.0);
      loop.move(velocity, 0.01);
    }
    const TaskError error = loop.error();
    EXPECT_LT(std::hypot(error.x - error.desired_x, error.y - error.desired_y), 1e-4);
    EXPECT_LT(std::abs(error.log_depth), 1e-3);
  }
}

// With oblique optics insertion moves the centre, too: what is not used has to be left out of the inverse, not of the
// velocity alone.
TEST(FeatureLaw, PanAndTiltAloneTakeTheCentreStraight) {
  const FeatureGains gains;
  const FeatureLaw law(gains, LawAxes{false, false});
  for (const Eigen::Matrix3d& optics : {Eigen::Matrix3d(Eigen::Matrix3d::Identity()), kOblique}) {
    PlaneLoop loop(Eigen::Vector3d::UnitZ(), kZ, {optics, kD2});
    loop.offset({0.1, -0.1, 0.1, 0.01});
    for (int k = 0; k < 400; ++k) {
      const TaskError error = loop.error();
      const scope::Velocity velocity = law.velocity(error, loop.scope()).sum();
      ASSERT_EQ(velocity.spin, 0.0);
      ASSERT_EQ(velocity.insertion, 0.0);
      const Eigen::Vector2d off(error.x - error.desired_x, error.y - error.desired_y);
      const double depth = depthOf(error, gains.desired_depth);
      const Eigen::Vector4d rate = featureJacobian(error.x, error.y, depth, loop.scope()) * velocity.vector();
      ASSERT_LT((rate.head<2>() + gains.centre * off).norm(), 1e-9 + 1e-9 * off.norm()) << k;
      loop.move(velocity, 0.01);
    }
    const TaskError error = loop.error();
    EXPECT_LT(std::hypot(error.x - error.desired_x, error.y - error.desired_y), 1e-4);
    EXPECT_GT(std::abs(error.log_depth), 0.05) << "the error that remains";
  }
}

TEST(FeatureLaw, TheInverseOfAPartIsThatOfItsBlock) {
  const Eigen::Matrix4d j = featureJacobian(0.2, -0.1, kZ, {kOblique, kD2});
  EXPECT_LT((inverseOf(j, LawAxes{true, true}) * j - Eigen::Matrix4d::Identity()).norm(), 1e-12);
  const Eigen::Matrix4d pan_tilt = inverseOf(j, LawAxes{false, false});
  EXPECT_LT((pan_tilt.topLeftCorner<2, 2>() * j.topLeftCorner<2, 2>() - Eigen::Matrix2d::Identity()).norm(), 1e-12);
  EXPECT_EQ(pan_tilt.bottomRows<2>().norm() + pan_tilt.rightCols<2>().norm(), 0.0);
  Eigen::Matrix3d block;  // x, y, alpha by pan, tilt, spin
  block << j.topLeftCorner<2, 3>(), j.block<1, 3>(3, 0);
  const Eigen::Matrix4d with_spin = inverseOf(j, LawAxes{true, false});
  Eigen::Matrix3d inverse;
  inverse << with_spin.topLeftCorner<3, 2>(), with_spin.block<3, 1>(0, 3);
  EXPECT_LT((inverse * block - Eigen::Matrix3d::Identity()).norm(), 1e-12);
  EXPECT_EQ(with_spin.row(3).norm() + with_spin.col(2).norm(), 0.0);
}

TEST(FeatureLaw, IsNotFiniteWhereTheErrorIsNot) {
  TaskError error;
  error.log_depth = std::nan("");
  EXPECT_FALSE(FeatureLaw(FeatureGains()).velocity(error, straight()).sum().vector().allFinite());
}

}  // namespace
}  // namespace laparoscope_servo::servo
