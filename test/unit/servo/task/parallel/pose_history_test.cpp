#include "servo/task/parallel/pose_history.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "laparoscope_servo/geometry/se3.h"

namespace laparoscope_servo::servo {
namespace {

// Turns evenly, and moves evenly.
Eigen::Isometry3d poseAt(double time) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = geometry::so3Exp(0.1 * time * Eigen::Vector3d(0.6, 0.8, 0.0));
  pose.translation() = Eigen::Vector3d(0.01, -0.02, 0.03) * time;
  return pose;
}

TEST(PoseHistory, TellsThePoseBetweenTwo) {
  PoseHistory history;
  for (int k = 0; k <= 100; ++k) history.add(0.02 * k, poseAt(0.02 * k));
  for (const double time : {1.0, 1.003, 1.617}) {
    ASSERT_TRUE(history.reaches(time));
    const auto pose = history.at(time);
    ASSERT_TRUE(pose);
    EXPECT_TRUE(pose->isApprox(poseAt(time), 1e-9)) << time;
  }
}

TEST(PoseHistory, WaitsForPosesAndKnowsNoneFromBefore) {
  PoseHistory history;
  EXPECT_FALSE(history.reaches(0.0));
  for (int k = 50; k <= 100; ++k) history.add(0.02 * k, poseAt(0.02 * k));
  EXPECT_FALSE(history.reaches(1.95));
  EXPECT_FALSE(history.at(1.95));
  EXPECT_FALSE(history.at(0.9));
  history.clear();
  EXPECT_FALSE(history.at(1.5));
}

TEST(PoseHistory, TakesOutTheNoiseOfSinglePoses) {
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0.0, 0.0035);
  double squares = 0.0;
  constexpr int kTrials = 200;
  for (int trial = 0; trial < kTrials; ++trial) {
    PoseHistory history;
    for (int k = 0; k <= 50; ++k) {
      Eigen::Isometry3d pose = poseAt(0.02 * k);
      pose.linear() *= geometry::so3Exp({noise(random), noise(random), 0.0});
      history.add(0.02 * k, pose);
    }
    squares += geometry::so3Log(poseAt(0.5).linear().transpose() * history.at(0.5)->linear()).squaredNorm() / 2.0;
  }
  EXPECT_LT(std::sqrt(squares / kTrials), 0.0035 / 2.5);
}

TEST(PoseHistory, IgnoresTimesThatDoNotIncreaseAndWhatIsNotFinite) {
  PoseHistory history;
  for (int k = 0; k <= 50; ++k) {
    history.add(0.02 * k, poseAt(0.02 * k));
    history.add(0.02 * k, poseAt(5.0));
    history.add(0.02 * k - 1.0, poseAt(5.0));
    Eigen::Isometry3d broken = poseAt(0.02 * k);
    broken.translation().x() = std::numeric_limits<double>::quiet_NaN();
    history.add(0.02 * k + 0.01, broken);
    history.add(std::numeric_limits<double>::infinity(), poseAt(1.0));
  }
  ASSERT_TRUE(history.at(0.5));
  EXPECT_TRUE(history.at(0.5)->isApprox(poseAt(0.5), 1e-9));
}

}  // namespace
}  // namespace laparoscope_servo::servo
