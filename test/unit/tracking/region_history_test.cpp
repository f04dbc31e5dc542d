#include "tracking/region_history.h"

#include <gtest/gtest.h>

namespace laparoscope_servo::tracking {
namespace {

const geometry::Rectangle kRoi = {90, 70, 101, 91};
constexpr double kDamping = 0.8;

Eigen::Matrix3d shift(double x, double y) {
  Eigen::Matrix3d g = Eigen::Matrix3d::Identity();
  g.topRightCorner<2, 1>() << x, y;
  return g;
}

Eigen::Matrix3d normalisation() {
  Eigen::Matrix3d n = Eigen::Matrix3d::Identity();
  n(0, 0) = n(1, 1) = 1.0 / 50.5;
  n.topRightCorner<2, 1>() = -kRoi.centre() / 50.5;
  return n;
}

// An accepted estimate; its blocks: all found, or seen and not found.
Evidence estimate(const Eigen::Matrix3d& g, bool found = true) {
  Evidence e;
  e.roi = kRoi;
  e.predicted = e.esm.state.g = g;
  e.esm.covariance = Matrix8d::Identity() * 1e-6;
  e.esm.state.gain = 1.25;
  e.esm.noise = 9.0;
  e.visible_fraction = 1.0;
  e.zncc = 0.95;
  e.blocks.seen = e.blocks.visible = 20;
  e.blocks.confident = found ? 20 : 0;
  return e;
}

class RegionHistoryTest : public ::testing::Test {
 protected:
  RegionHistory history_{kDamping};

  Evidence compared(double stamp) const {
    Evidence e;
    history_.compare(stamp, e);
    return e;
  }
  void track(const Evidence& found, double stamp) {
    history_.addTracked(found, history_.predict(stamp, std::nullopt), stamp, std::nullopt);
  }
};

TEST_F(RegionHistoryTest, TimesAreSinceTheReferenceAtFirst) {
  history_.start(kRoi, normalisation(), 10.0);
  EXPECT_DOUBLE_EQ(compared(10.5).unseen, 0.5);
  EXPECT_DOUBLE_EQ(compared(10.5).unproven, 0.5);
  EXPECT_DOUBLE_EQ(history_.sinceLast(10.5), 0.5);
  EXPECT_TRUE(history_.last().g.isIdentity());
}

TEST_F(RegionHistoryTest, ARecalledRegionWasNotSeenSinceItsReferenceButIsSearchedSinceNow) {
  history_.startUnseen(kRoi, normalisation(), 3.0, 10.0);
  EXPECT_DOUBLE_EQ(compared(10.5).unseen, 7.5);
  EXPECT_DOUBLE_EQ(history_.sinceLast(10.5), 0.5);
  history_.addFoundAgain(estimate(shift(2, 0)), 10.5);
  EXPECT_DOUBLE_EQ(compared(10.75).unseen, 0.25);
  history_.startUnseen(kRoi, normalisation(), 12.0, 10.0);  // a reference that is newer than the image
  EXPECT_DOUBLE_EQ(compared(10.5).unseen, 0.5);
}

TEST_F(RegionHistoryTest, WhatIsTrackedGoesOnAndIsLearned) {
  history_.start(kRoi, normalisation(), 0.0);
  const double before = history_.record().zncc();
  track(estimate(shift(3, -1)), 0.04);
  EXPECT_GT(history_.record().zncc(), before);
  EXPECT_DOUBLE_EQ(compared(0.08).last_gain, 1.25);
  EXPECT_DOUBLE_EQ(compared(0.08).record.zncc(), history_.record().zncc());
  const Eigen::Matrix3d next = history_.predict(0.08, std::nullopt).predicted;
  EXPECT_NEAR(next(0, 2), 3.0 + kDamping * 3.0, 1e-6);
  EXPECT_NEAR(next(1, 2), -1.0 - kDamping * 1.0, 1e-6);
}

TEST_F(RegionHistoryTest, AMissStopsTheMotionAndKeepsTheRest) {
  history_.start(kRoi, normalisation(), 0.0);
  track(estimate(shift(3, -1)), 0.04);
  history_.addMiss();
  EXPECT_TRUE(history_.predict(0.08, std::nullopt).predicted.isApprox(shift(3, -1), 1e-9));
  EXPECT_DOUBLE_EQ(history_.sinceLast(0.08), 0.04);
  EXPECT_DOUBLE_EQ(compared(0.08).last_gain, 1.25);
}

TEST_F(RegionHistoryTest, ARegionThatIsFoundAgainStandsStillAndTeachesNothing) {
  history_.start(kRoi, normalisation(), 0.0);
  track(estimate(shift(3, -1)), 0.04);
  const double zncc = history_.record().zncc();
  history_.addFoundAgain(estimate(shift(40, 20)), 1.0);
  EXPECT_EQ(history_.record().zncc(), zncc);
  EXPECT_TRUE(history_.predict(1.04, std::nullopt).predicted.isApprox(shift(40, 20), 1e-9));
}

TEST_F(RegionHistoryTest, OnlyBlocksThatAreFoundProveAnEstimate) {
  history_.start(kRoi, normalisation(), 0.0);
  track(estimate(shift(0, 0), false), 0.25);
  EXPECT_DOUBLE_EQ(compared(0.5).unproven, 0.5);
  EXPECT_DOUBLE_EQ(compared(0.5).unseen, 0.25);
  track(estimate(shift(0, 0)), 0.5);
  EXPECT_DOUBLE_EQ(compared(0.75).unproven, 0.25);
}

TEST_F(RegionHistoryTest, KnowsHowMuchWasVisibleWhenBlocksWereFound) {
  history_.start(kRoi, normalisation(), 0.0);
  EXPECT_EQ(compared(0.1).proven_visible, 1.0);
  Evidence half = estimate(shift(0, 0));
  half.visible_fraction = 0.5;
  track(half, 0.2);
  EXPECT_EQ(compared(0.3).proven_visible, 0.5);
  Evidence unproven = estimate(shift(0, 0), false);
  unproven.visible_fraction = 0.4;
  track(unproven, 0.4);
  EXPECT_EQ(compared(0.5).proven_visible, 0.5);
  history_.start(kRoi, normalisation(), 1.0);
  EXPECT_EQ(compared(1.1).proven_visible, 1.0);
}

}  // namespace
}  // namespace laparoscope_servo::tracking
