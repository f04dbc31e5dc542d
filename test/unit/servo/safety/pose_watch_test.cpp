#include "laparoscope_servo/servo/pose_watch.h"

#include <gtest/gtest.h>

#include "laparoscope_servo/geometry/se3.h"

namespace laparoscope_servo::servo {
namespace {

Eigen::Isometry3d moved(double x, double turn = 0.0) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() << x, 0.0, -0.1;
  pose.linear() = geometry::so3Exp({0.0, turn, 0.0});
  return pose;
}

class PoseWatchTest : public ::testing::Test {
 protected:
  PoseWatch::Verdict judge(const Eigen::Isometry3d& pose, bool engaged = true,
                           const Eigen::Isometry3d& optics = Eigen::Isometry3d::Identity()) {
    time_ += 0.025;
    return watch_.judge(1000.0 + time_, time_, pose, optics, engaged);
  }
  void expectGood(const PoseWatch::Verdict& verdict) {
    EXPECT_EQ(verdict.problem, "");
    EXPECT_EQ(verdict.fault, "");
  }

  double time_ = 0.0;  // s
  PoseWatch watch_{SafetyConfig()};
};

TEST_F(PoseWatchTest, WhatTheArmDoesIsBelieved) {
  expectGood(judge(moved(0.0), false));
  for (int k = 1; k < 200; ++k) expectGood(judge(moved(0.06 * 0.025 * k, 0.4 * 0.025 * k)));
}

// Two answers of the arm that a busy machine has read at once have stamps 1 ms apart.
TEST_F(PoseWatchTest, StampsMayBeNearerToEachOtherThanThePoses) {
  expectGood(judge(moved(0.0), false));
  for (int k = 1; k < 100; ++k) {
    time_ += 0.049;
    expectGood(judge(moved(0.06 * 0.1 * (2 * k - 1))));
    time_ -= 0.024;
    expectGood(judge(moved(0.06 * 0.1 * (2 * k - 0.5))));
    time_ += 0.1;
  }
}

TEST_F(PoseWatchTest, AStrayPoseIsNotUsedAndTheNextOneIs) {
  for (const Eigen::Isometry3d& stray : {moved(0.05), moved(0.0, 0.3), moved(-0.05), moved(0.0, -0.3)}) {
    watch_ = PoseWatch(SafetyConfig());
    judge(moved(0.0), false);
    expectGood(judge(moved(0.0)));
    const PoseWatch::Verdict verdict = judge(stray);
    EXPECT_NE(verdict.problem.find("jumped"), std::string::npos);
    EXPECT_EQ(verdict.fault, "");
    expectGood(judge(moved(0.0)));
  }
}

TEST_F(PoseWatchTest, AJumpThatStaysIsAFaultAndItsWordsStay) {
  judge(moved(0.0), false);
  const std::string words = judge(moved(0.05)).problem;
  int steps = 0;
  for (; steps < 100; ++steps) {
    const PoseWatch::Verdict verdict = judge(moved(0.05 + 0.0001 * steps));
    EXPECT_EQ(verdict.problem, words);
    if (!verdict.fault.empty()) break;
  }
  EXPECT_LT(steps * 0.025, 0.6);
}

TEST_F(PoseWatchTest, TwoWhoTellThePoseInTurnAreAFault) {
  judge(moved(0.0), false);
  int steps = 0;
  for (; steps < 20; ++steps) {
    if (!judge(moved(steps % 2 == 0 ? 0.06 : 0.0)).fault.empty()) break;
  }
  EXPECT_LT(steps, 6);
}

// However long nothing came: the arm stands meanwhile.
TEST_F(PoseWatchTest, ATransformThatWasSilentDoesNotHideAJump) {
  judge(moved(0.0), false);
  time_ += 20.0;
  EXPECT_NE(judge(moved(0.05)).problem, "");
}

TEST_F(PoseWatchTest, WhileNotEngagedTheArmIsMovedByHand) {
  for (int k = 0; k < 20; ++k) expectGood(judge(moved(0.2 * (k % 2), 0.5 * (k % 2)), false));
  expectGood(judge(moved(0.2, 0.5)));  // engaged where it is
  EXPECT_NE(judge(moved(0.0)).problem, "");
  expectGood(judge(moved(0.0), false));
  expectGood(judge(moved(0.0)));
}

TEST_F(PoseWatchTest, OpticsThatChangeWhileEngagedAreAFault) {
  for (const Eigen::Isometry3d& other : {Eigen::Isometry3d(Eigen::Translation3d(0.0, 0.0, 0.001)),
                                         Eigen::Isometry3d(Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitZ()))}) {
    watch_ = PoseWatch(SafetyConfig());
    expectGood(judge(moved(0.0), false));
    expectGood(judge(moved(0.0)));
    EXPECT_NE(judge(moved(0.0), true, other).fault, "");
    expectGood(judge(moved(0.0), false, other));
    expectGood(judge(moved(0.0), true, other));
  }
}

TEST_F(PoseWatchTest, OpticsFarFromTheShaftsFrameAreAProblemAtAnyTime) {
  const Eigen::Isometry3d far(Eigen::Translation3d(0.0, 0.0, 0.05));
  EXPECT_NE(judge(moved(0.0), false, far).problem.find("0.05 m"), std::string::npos);
  EXPECT_NE(judge(moved(0.0), true, far).problem, "");
}

TEST_F(PoseWatchTest, WhatIsNotFiniteIsNoPose) {
  judge(moved(0.0), false);
  EXPECT_NE(judge(moved(std::numeric_limits<double>::quiet_NaN())).problem, "");
  const Eigen::Isometry3d optics(Eigen::Translation3d(0.0, 0.0, std::numeric_limits<double>::quiet_NaN()));
  EXPECT_NE(judge(moved(0.0), false, optics).problem, "");
}

}  // namespace
}  // namespace laparoscope_servo::servo
