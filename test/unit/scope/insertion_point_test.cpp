#include "laparoscope_servo/scope/insertion_point.h"

#include <gtest/gtest.h>

#include <random>

namespace laparoscope_servo::servo {
namespace {

using geometry::Vector6d;

class InsertionPoint : public ::testing::Test {
 protected:
  double between(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }

  scope::Velocity anyVelocity() { return {between(-1, 1), between(-1, 1), between(-1, 1), between(-0.1, 0.1)}; }

  std::mt19937 random_{1};
};

Eigen::Isometry3d alongShaft(double distance) {
  return Eigen::Isometry3d(Eigen::Translation3d(0.0, 0.0, distance));
}

// Eq. (9) is the transport of a rigid body's velocity.
TEST_F(InsertionPoint, TransportIsThatOfARigidBody) {
  for (int k = 0; k < 100; ++k) {
    const double d2 = between(0.01, 0.3);
    Vector6d twist;
    for (int i = 0; i < 6; ++i) twist[i] = between(-1, 1);
    const Vector6d expected = geometry::twistTransform(alongShaft(d2)) * twist;  // insertion_T_camera
    EXPECT_NEAR((scope::twistAtInsertionPoint(twist, d2) - expected).norm(), 0.0, 1e-14);
  }
}

// Eq. (10), as corrected: what it constrains is that nothing moves sideways at the insertion point.
TEST_F(InsertionPoint, ScopeMotionsDoNotMoveTheInsertionPointSideways) {
  for (int k = 0; k < 100; ++k) {
    const double d2 = between(0.01, 0.3);
    const scope::Velocity velocity = anyVelocity();
    const Vector6d there = scope::twistAtInsertionPoint(scope::cameraTwist(velocity, d2), d2);
    Vector6d expected;
    expected << 0.0, 0.0, velocity.insertion, velocity.tilt, velocity.pan, velocity.spin;
    EXPECT_NEAR((there - expected).norm(), 0.0, 1e-15);
  }
}

TEST_F(InsertionPoint, ProjectionUndoesTheEmbedding) {
  for (int k = 0; k < 100; ++k) {
    const double d2 = between(0.01, 0.3);
    const scope::Velocity velocity = anyVelocity();
    const scope::Velocity again =
        scope::aboutInsertionPoint(scope::cameraTwist(velocity, d2), d2);  // eq. (11) after (10)
    EXPECT_NEAR((again.vector() - velocity.vector()).norm(), 0.0, 1e-14);
  }
}

// Eq. (11): the camera centre gets the translation that was wanted, whatever rotation was wanted.
TEST_F(InsertionPoint, ProjectionKeepsTranslationAndSpin) {
  for (int k = 0; k < 100; ++k) {
    const double d2 = between(0.01, 0.3);
    Vector6d wanted;
    for (int i = 0; i < 6; ++i) wanted[i] = between(-1, 1);
    const Vector6d done = scope::cameraTwist(scope::aboutInsertionPoint(wanted, d2), d2);
    EXPECT_NEAR((done.head<3>() - wanted.head<3>()).norm(), 0.0, 1e-14);
    EXPECT_NEAR(done[5], wanted[5], 1e-15);
  }
}

TEST_F(InsertionPoint, SignsOfTheFourMotions) {
  const double d2 = 0.1;
  // Camera to the right by the lever: the scope turns to the right about y. Camera down: it turns down, -x.
  Vector6d right = Vector6d::Zero();
  right[0] = 1.0;
  EXPECT_DOUBLE_EQ(scope::aboutInsertionPoint(right, d2).pan, 10.0);
  Vector6d down = Vector6d::Zero();
  down[1] = 1.0;
  EXPECT_DOUBLE_EQ(scope::aboutInsertionPoint(down, d2).tilt, -10.0);
  Vector6d deeper = Vector6d::Zero();
  deeper[2] = 1.0;
  EXPECT_DOUBLE_EQ(scope::aboutInsertionPoint(deeper, d2).insertion, 1.0);
  Vector6d clockwise = Vector6d::Zero();
  clockwise[5] = 1.0;
  EXPECT_DOUBLE_EQ(scope::aboutInsertionPoint(clockwise, d2).spin, 1.0);
}

// Eq. (12) in both of its forms, and against the rigid body.
TEST_F(InsertionPoint, EndEffectorMovesAsTheOtherEndOfTheSameBody) {
  for (int k = 0; k < 100; ++k) {
    const double d1 = between(0.01, 0.3);
    const double d2 = between(0.01, 0.3);
    const scope::Velocity velocity = anyVelocity();
    const Vector6d camera = scope::cameraTwist(velocity, d2);
    const Vector6d twist = scope::endEffectorTwist(velocity, d1);
    EXPECT_NEAR((geometry::twistTransform(alongShaft(d1 + d2)) * camera - twist).norm(), 0.0, 1e-14);
    Vector6d from_camera_velocity;
    from_camera_velocity << -d1 / d2 * camera[0], -d1 / d2 * camera[1], camera[2], -camera[1] / d2, camera[0] / d2,
        camera[5];
    EXPECT_NEAR((from_camera_velocity - twist).norm(), 0.0, 1e-14);
  }
}

}  // namespace
}  // namespace laparoscope_servo::servo
