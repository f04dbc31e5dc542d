#include "laparoscope_servo/geometry/plane_motion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "laparoscope_servo/geometry/homography.h"
#include "laparoscope_servo/geometry/se3.h"

namespace laparoscope_servo::geometry {
namespace {

const Eigen::Vector3d kPoint(0.1, -0.05, 1.0);

struct Case {
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
  double distance = 0.08;  // m
  Eigen::Matrix3d h() const { return fromPlane(motion, normal, distance); }
};

Case drawn(std::mt19937& random, double angle, double way, double slant) {
  std::uniform_real_distribution<double> one(-1.0, 1.0);
  const auto vector = [&] { return Eigen::Vector3d(one(random), one(random), one(random)); };
  Case c;
  c.motion.linear() = so3Exp(angle * vector());
  c.motion.translation() = way * vector();
  c.normal = so3Exp({slant * one(random), slant * one(random), 0.0}) * Eigen::Vector3d::UnitZ();
  return c;
}

double wrongness(const PlaneMotion& found, const Case& truth) {
  return std::max({(found.rotation - truth.motion.linear()).norm(), (found.normal - truth.normal).norm(),
                   (found.translation - truth.motion.translation() / truth.distance).norm()});
}

TEST(PlaneMotion, OneOfTheTwoIsTheTruthAndBothExplainTheHomography) {
  std::mt19937 random(3);
  for (int k = 0; k < 200; ++k) {
    const Case truth = drawn(random, 0.4, 0.02, 0.6);
    const auto found = planeMotions(euclideanScale(-2.0 * truth.h(), kPoint), kPoint);
    EXPECT_LT(std::min(wrongness(found[0], truth), wrongness(found[1], truth)), 1e-7) << k;
    for (const PlaneMotion& motion : found) {
      EXPECT_LT((motion.rotation * motion.rotation.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-12);
      EXPECT_GT(motion.rotation.determinant(), 0.0);
      EXPECT_NEAR(motion.normal.norm(), 1.0, 1e-12);
      EXPECT_GT(motion.normal.dot(kPoint), 0.0);
      EXPECT_LT((motion.rotation + motion.translation * motion.normal.transpose() - truth.h()).norm(), 1e-7) << k;
    }
  }
}

TEST(PlaneMotion, OfARotationAloneItIsThatRotation) {
  std::mt19937 random(4);
  for (int k = 0; k < 20; ++k) {
    const Case truth = drawn(random, 1.0, 0.0, 0.6);
    for (const PlaneMotion& motion : planeMotions(truth.h(), kPoint)) {
      EXPECT_LT((motion.rotation - truth.motion.linear()).norm(), 1e-9);
      EXPECT_EQ(motion.translation.norm(), 0.0);
    }
  }
}

// There the two are one.
TEST(PlaneMotion, AlongTheNormalThereIsOne) {
  Case truth;
  truth.normal = so3Exp({0.3, -0.2, 0.0}) * Eigen::Vector3d::UnitZ();
  truth.motion.translation() = -0.02 * truth.normal;
  for (const PlaneMotion& motion : planeMotions(euclideanScale(truth.h(), kPoint), kPoint))
    EXPECT_LT(wrongness(motion, truth), 1e-6);
}

// A measured homography has noise in its singular values.
TEST(PlaneMotion, NoiseChangesItByAsMuch) {
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0.0, 1e-4);
  for (int k = 0; k < 50; ++k) {
    const Case truth = drawn(random, 0.3, 0.02, 0.4);
    Eigen::Matrix3d h = truth.h();
    for (int i = 0; i < 9; ++i) h(i / 3, i % 3) += noise(random);
    const auto found = planeMotions(euclideanScale(h, kPoint), kPoint);
    const double wrong = std::min((found[0].rotation - truth.motion.linear()).norm(),
                                  (found[1].rotation - truth.motion.linear()).norm());
    EXPECT_LT(wrong, 0.05) << k;
  }
}

}  // namespace
}  // namespace laparoscope_servo::geometry
