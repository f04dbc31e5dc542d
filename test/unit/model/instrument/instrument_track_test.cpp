#include "model/instrument/instrument_track.h"

#include <gtest/gtest.h>

#include <cmath>

#include "features/shafts/shaft_finder.h"
#include "laparoscope_servo/geometry/homography.h"
#include "model/instrument/grey_plane.h"
#include "support/synthetic_instrument.h"

namespace laparoscope_servo::model {
namespace {

using features::State;
using test_support::drawShaft;
using test_support::ShaftScene;

// A picture, and what is seen in it.
struct Seen {
  explicit Seen(const ShaftScene& scene, double time = 0.0, const std::optional<Eigen::Matrix3d>& moved = std::nullopt)
      : image(drawShaft(scene).image), stamp(time), motion(moved) {
    plane.compute(image, cv::Rect({}, image.size()));
    map.compute(image);
    view.compute(map.level());
    levels = features::greyLevels(map, view);
    shafts = finder.find(map, view, levels);
  }
  InstrumentScene scene() const { return {image, plane.plane(), stamp, motion, map, view, levels}; }

  cv::Mat image;
  double stamp;
  std::optional<Eigen::Matrix3d> motion;
  GreyPlane plane;
  GreyMap map;
  image::FieldOfView view;
  GreyLevels levels;
  features::ShaftFinder finder;
  std::vector<Shaft> shafts;
};

Eigen::Matrix3d shiftBy(double x, double y) {
  Eigen::Matrix3d g = Eigen::Matrix3d::Identity();
  g.topRightCorner<2, 1>() << x, y;
  return g;
}

ShaftScene moved(double x, double y) {
  ShaftScene scene;
  scene.tip += cv::Point2d(x, y);
  scene.entry += cv::Point2d(x, y);
  return scene;
}

Instrument told(const InstrumentTrack& track, const Seen& seen) {
  Instrument result;
  track.tell(seen.map, std::nullopt, result);
  return result;
}

class InstrumentTrackTest : public testing::Test {
 protected:
  void SetUp() override { ASSERT_EQ(first_.shafts.size(), 1u); }

  InstrumentConfig config_;
  Seen first_{ShaftScene()};
};

TEST_F(InstrumentTrackTest, TellsWhatItWasMadeOf) {
  const InstrumentTrack track(config_, 7, first_.scene(), first_.shafts[0]);
  const Instrument told_now = told(track, first_);
  EXPECT_EQ(told_now.id, 7);
  EXPECT_EQ(told_now.state, State::kTracking);
  EXPECT_EQ(track.fineEdges(), 2);
  const ShaftScene scene;
  const Eigen::Vector2d axis = Eigen::Vector2d(scene.tip.x - scene.entry.x, scene.tip.y - scene.entry.y).normalized();
  EXPECT_NEAR(axis.dot(told_now.tip - Eigen::Vector2d(scene.tip.x, scene.tip.y)), 0.0, 4.0);
  for (std::size_t k = 0; k < 2; ++k) {
    const InstrumentEdge& edge = told_now.edges[k];
    // Half of the width at the tip, 60 px, on either side of the axis, right (k = 0) and left.
    const double at_tip = std::cos(edge.theta) * scene.tip.x + std::sin(edge.theta) * scene.tip.y - edge.rho;
    EXPECT_NEAR(at_tip, -30.0, 1.0) << k;
    EXPECT_GT(axis.dot(edge.end - edge.begin), 0.0) << "towards the tip";
    EXPECT_LT(edge.expected_error, 1.5);
    EXPECT_GT(edge.covariance.determinant(), 0.0);
  }
  // Edge 0 is on the right: its normal is the axis (x, y) turned to (-y, x).
  EXPECT_GT(std::cos(told_now.edges[0].theta) * -axis.y() + std::sin(told_now.edges[0].theta) * axis.x(), 0.98);
  EXPECT_FALSE(told_now.pose);
}

TEST_F(InstrumentTrackTest, IsExpectedWhereTheCamerasMotionLeadsIt) {
  InstrumentTrack track(config_, 0, first_.scene(), first_.shafts[0]);
  const Seen there(moved(0.0, 150.0), 0.04, shiftBy(0.0, 150.0));
  ASSERT_EQ(there.shafts.size(), 1u);
  EXPECT_FALSE(track.isExpectedAt(there.scene(), there.shafts[0]));
  track.predict(there.scene());
  EXPECT_TRUE(track.isExpectedAt(there.scene(), there.shafts[0]));
  EXPECT_NEAR((track.shaft().entry - there.shafts[0].entry).norm(), 0.0, 2.0) << "cells";
  track.update(there.scene(), &there.shafts[0]);
  EXPECT_EQ(track.state(), State::kTracking);
}

TEST_F(InstrumentTrackTest, AMotionThatNoCameraMakesMovesNothing) {
  InstrumentTrack track(config_, 0, first_.scene(), first_.shafts[0]);
  const Eigen::Vector2d entry = track.shaft().entry;
  Eigen::Matrix3d to_infinity = Eigen::Matrix3d::Identity();
  to_infinity.row(2).setZero();
  for (const Eigen::Matrix3d& wrong : {shiftBy(1e5, 0.0), shiftBy(std::nan(""), 0.0), to_infinity}) {
    const Seen seen(ShaftScene(), 0.04, wrong);
    track.predict(seen.scene());
    EXPECT_EQ(track.shaft().entry, entry);
  }
}

TEST_F(InstrumentTrackTest, AnotherShaftIsNotTakenForIt) {
  const InstrumentTrack track(config_, 0, first_.scene(), first_.shafts[0]);
  ShaftScene opposite;
  opposite.entry = {-20.0, 150.0};
  const Seen other(opposite);
  ASSERT_EQ(other.shafts.size(), 1u);
  EXPECT_FALSE(track.isExpectedAt(other.scene(), other.shafts[0]));
  ShaftScene thin = moved(0.0, 12.0);
  thin.tip_width = 25.0;
  thin.entry_width = 30.0;
  const Seen narrow(thin);
  ASSERT_EQ(narrow.shafts.size(), 1u);
  Shaft aside = narrow.shafts[0];
  aside.entry += Eigen::Vector2d(0.0, aside.width);  // beside it, within reach but of another width
  for (GreyLine& edge : aside.edges) edge.point += Eigen::Vector2d(0.0, aside.width);
  EXPECT_FALSE(track.isExpectedAt(narrow.scene(), aside));
}

TEST_F(InstrumentTrackTest, WhatIsNoLongerSeenIsSearchedThenLostAndOutOfTheMask) {
  InstrumentTrack track(config_, 0, first_.scene(), first_.shafts[0]);
  cv::Mat1b covered(first_.image.size(), uchar{0});
  track.draw(first_.map, first_.levels.threshold, covered);
  EXPECT_EQ(covered(300, 450), 255);
  ShaftScene none;
  none.with_shaft = false;
  Seen empty(none, 0.04);
  track.update(empty.scene(), nullptr);
  EXPECT_EQ(track.state(), State::kSearching);
  EXPECT_TRUE(std::isinf(told(track, empty).expected_error));
  covered.setTo(0);
  track.draw(empty.map, empty.levels.threshold, covered);
  EXPECT_EQ(covered(300, 450), 255) << "where it was seen last";
  empty.stamp = 0.04 + config_.max_search_time + 0.1;
  track.update(empty.scene(), nullptr);
  EXPECT_EQ(track.state(), State::kLost);
  covered.setTo(0);
  track.draw(empty.map, empty.levels.threshold, covered);
  EXPECT_EQ(cv::countNonZero(covered), 0);
}

TEST_F(InstrumentTrackTest, OneImageIsNotEnoughToBeBelievedAgain) {
  InstrumentTrack track(config_, 0, first_.scene(), first_.shafts[0]);
  ShaftScene none;
  none.with_shaft = false;
  Seen empty(none, 0.04);
  track.update(empty.scene(), nullptr);
  Seen back(ShaftScene(), 0.08);
  ASSERT_EQ(back.shafts.size(), 1u);
  track.update(back.scene(), &back.shafts[0]);
  EXPECT_EQ(track.state(), State::kSearching);
  back.stamp = 0.12;
  track.update(back.scene(), &back.shafts[0]);
  EXPECT_EQ(track.state(), State::kTracking);
}

}  // namespace
}  // namespace laparoscope_servo::model
