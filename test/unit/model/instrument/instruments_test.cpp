#include "laparoscope_servo/model/instruments.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "support/synthetic_instrument.h"

namespace laparoscope_servo::model {
namespace {

using features::State;
using test_support::drawShaft;
using test_support::ShaftScene;

constexpr double kPeriod = 0.04;  // s

// A shaft that turns about a trocar at (900, 350) px, and moves in and out.
ShaftScene at(int k) {
  ShaftScene scene;
  const double angle = 3.3 + 0.15 * std::sin(0.15 * k);
  const cv::Point2d trocar(900.0, 350.0), direction(std::cos(angle), std::sin(angle));
  scene.entry = trocar + 200.0 * direction;
  scene.tip = trocar + (620.0 + 40.0 * std::sin(0.11 * k)) * direction;
  scene.seed = k + 1;
  return scene;
}

TEST(InstrumentTracker, FollowsAShaftFromTheFirstImageOn) {
  InstrumentTracker tracker;
  for (int k = 0; k < 60; ++k) {
    const ShaftScene scene = at(k);
    const auto picture = drawShaft(scene);
    const InstrumentsResult& result = tracker.track(picture.image, k * kPeriod);
    ASSERT_EQ(result.instruments.size(), 1u) << k;
    const Instrument& i = result.instruments[0];
    EXPECT_EQ(i.state, State::kTracking) << k;
    EXPECT_EQ(i.id, 1) << k;
    EXPECT_NEAR(i.axis.dot(Eigen::Vector2d(scene.tip.x, scene.tip.y) - i.tip), 0.0, 6.0)
        << k;  // two cells of the reduced image
    EXPECT_LT(i.expected_error, 3.0) << k;
    const double covered = cv::countNonZero(result.mask & picture.mask);
    EXPECT_GT(covered, 0.98 * cv::countNonZero(picture.mask)) << k;
    EXPECT_LT(cv::countNonZero(result.mask), 1.2 * cv::countNonZero(picture.mask)) << k;
  }
  // Its axes have met in the trocar's image.
  const Instrument& i = tracker.result().instruments[0];
  ASSERT_TRUE(i.trocar);
  EXPECT_NEAR(i.trocar->x(), 900.0, 40.0);
  EXPECT_NEAR(i.trocar->y(), 350.0, 15.0);
}

// The same scene in 1920x1080: found as soon, covered as well, and its edges lie as near to those that are drawn.
TEST(InstrumentTracker, FollowsAShaftInLargeImages) {
  constexpr double kScale = 1920.0 / 640.0;
  InstrumentTracker tracker;
  for (int k = 0; k < 8; ++k) {
    ShaftScene scene = at(k);
    scene.size = {1920, 1080};
    scene.entry = kScale * scene.entry;
    scene.tip = kScale * scene.tip;
    scene.entry_width *= kScale;
    scene.tip_width *= kScale;
    const auto picture = drawShaft(scene);
    const InstrumentsResult& result = tracker.track(picture.image, k * kPeriod);
    ASSERT_EQ(result.instruments.size(), 1u) << k;
    const Instrument& i = result.instruments[0];
    EXPECT_EQ(i.state, State::kTracking) << k;
    EXPECT_NEAR(i.axis.dot(Eigen::Vector2d(scene.tip.x, scene.tip.y) - i.tip), 0.0, kScale * 6.0) << k;
    EXPECT_LT(i.expected_error, 3.0) << k;
    ASSERT_EQ(result.mask.size(), scene.size);
    const double covered = cv::countNonZero(result.mask & picture.mask);
    EXPECT_GT(covered, 0.98 * cv::countNonZero(picture.mask)) << k;
    EXPECT_LT(cv::countNonZero(result.mask), 1.2 * cv::countNonZero(picture.mask)) << k;
  }
}

// Between tissue and shaft there is no step of brightness, and little contrast of colour: it has to last.
TEST(InstrumentTracker, AShaftAsDarkAsTheTissueIsTakenOnceItHasLasted) {
  InstrumentTracker tracker;
  for (int k = 0; k < 12; ++k) {
    ShaftScene scene;
    scene.tissue = {90, 90, 170};
    scene.shaft = {106, 106, 138};
    scene.seed = k + 1;
    const InstrumentsResult& result = tracker.track(drawShaft(scene).image, k * kPeriod);
    EXPECT_EQ(result.instruments.size(), k + 1 < InstrumentConfig().confirmations ? 0u : 1u) << k;
  }
}

// A strip that is brighter than the rest, with two straight edges, and just grey enough to be a shaft by its outline.
TEST(InstrumentTracker, PaleTissueWithTwoEdgesIsNone) {
  InstrumentTracker tracker;
  for (int k = 0; k < 12; ++k) {
    ShaftScene scene;
    scene.tissue = {90, 90, 170};
    scene.shaft = {130, 130, 182};
    scene.seed = k + 1;
    EXPECT_TRUE(tracker.track(drawShaft(scene).image, k * kPeriod).instruments.empty()) << k;
  }
}

TEST(InstrumentTracker, TheSameImagesGiveTheSameNumbers) {
  InstrumentTracker a, b;
  for (int k = 0; k < 10; ++k) {
    const cv::Mat image = drawShaft(at(k)).image;
    a.track(image, k * kPeriod);
    b.track(image, k * kPeriod);
    ASSERT_EQ(a.result().instruments.size(), b.result().instruments.size());
    EXPECT_EQ(a.result().instruments[0].tip, b.result().instruments[0].tip);
    EXPECT_EQ(a.result().instruments[0].edges[0].rho, b.result().instruments[0].edges[0].rho);
    EXPECT_EQ(cv::countNonZero(a.result().mask != b.result().mask), 0);
  }
}

TEST(InstrumentTracker, OneThatLeavesIsSearchedThenLostAndOutOfTheMask) {
  InstrumentTracker tracker;
  int k = 0;
  for (; k < 10; ++k) tracker.track(drawShaft(at(k)).image, k * kPeriod);
  ShaftScene empty;
  empty.with_shaft = false;
  EXPECT_EQ(tracker.track(drawShaft(empty).image, k * kPeriod).instruments[0].state, State::kSearching);
  EXPECT_EQ(tracker.result().instruments[0].reason, features::Reason::kNotSeen);
  EXPECT_TRUE(std::isinf(tracker.result().instruments[0].expected_error));
  EXPECT_GT(cv::countNonZero(tracker.result().mask), 0);
  const double later = k * kPeriod + 2.1;
  EXPECT_EQ(tracker.track(drawShaft(empty).image, later).instruments[0].state, State::kLost);
  EXPECT_EQ(cv::countNonZero(tracker.result().mask), 0);
}

TEST(InstrumentTracker, RefusesWhatItCannotUseAndGoesOn) {
  InstrumentTracker tracker;
  const cv::Mat image = drawShaft(at(0)).image;
  tracker.track(image, 0.0);
  EXPECT_THROW(tracker.track(cv::Mat(), 0.1), std::invalid_argument);
  EXPECT_THROW(tracker.track(cv::Mat(480, 640, CV_8UC1), 0.1), std::invalid_argument);
  EXPECT_THROW(tracker.track(cv::Mat(40, 640, CV_8UC3), 0.1), std::invalid_argument);
  EXPECT_THROW(tracker.track(image, std::nan("")), std::invalid_argument);
  EXPECT_THROW(tracker.setCamera(geometry::PinholeCamera{}), std::invalid_argument);
  EXPECT_EQ(tracker.track(image, 0.1).instruments[0].id, 1);
  // A motion that no camera makes is none.
  const double infinite = std::numeric_limits<double>::infinity();
  double stamp = 0.2;
  for (const double wrong : {std::nan(""), infinite, 0.0, 1e4, 1e9, 1e200, -1e200}) {
    Eigen::Matrix3d scaled = Eigen::Matrix3d::Identity(), shifted = scaled;
    scaled.topLeftCorner<2, 2>() *= wrong;
    shifted(0, 2) = wrong == 0.0 ? 1e6 : wrong;
    for (const Eigen::Matrix3d& motion : {Eigen::Matrix3d(Eigen::Matrix3d::Constant(wrong)), scaled, shifted}) {
      const InstrumentsResult& result = tracker.track(image, stamp += 0.04, motion);
      ASSERT_EQ(result.instruments.size(), 1u) << motion;
      EXPECT_EQ(result.instruments[0].id, 1) << motion;
      EXPECT_EQ(result.instruments[0].state, State::kTracking) << motion;
      EXPECT_TRUE(result.instruments[0].tip.allFinite()) << motion;
    }
  }
}

TEST(InstrumentTracker, AnotherSizeOrTimeThatJumpsBackStartsAnew) {
  InstrumentTracker tracker;
  tracker.track(drawShaft(at(0)).image, 1.0);
  tracker.track(drawShaft(at(1)).image, 0.5);
  EXPECT_EQ(tracker.result().instruments[0].id, 2);
  ShaftScene larger = at(2);
  larger.size = {700, 480};
  EXPECT_EQ(tracker.track(drawShaft(larger).image, 0.6).mask.cols, 700);
  tracker.reset();
  EXPECT_TRUE(tracker.result().instruments.empty());
}

TEST(InstrumentTracker, PoseNeedsCameraAndRadius) {
  InstrumentConfig config;
  InstrumentTracker without(config);
  without.setCamera(geometry::PinholeCamera{700.0, 700.0, 320.0, 240.0});
  EXPECT_FALSE(without.track(drawShaft(at(0)).image, 0.0).instruments[0].pose);
  config.radius = 0.004;
  InstrumentTracker with(config);
  EXPECT_FALSE(with.track(drawShaft(at(0)).image, 0.0).instruments[0].pose);
  with.setCamera(geometry::PinholeCamera{700.0, 700.0, 320.0, 240.0});
  const auto pose = with.track(drawShaft(at(1)).image, kPeriod).instruments[0].pose;
  ASSERT_TRUE(pose);
  // 60 to 90 px wide, 8 mm thick: 6 to 9 cm away, and nearer at the entry.
  EXPECT_NEAR(pose->point.z(), 0.09, 0.015);
  EXPECT_GT(pose->direction.z(), 0.0);
}

TEST(InstrumentTracker, AConfigurationThatCannotBeUsedIsRefused) {
  InstrumentConfig config;
  config.most = 4;
  config.radius = -1.0;
  config.edges.range = std::nan("");
  EXPECT_EQ(validate(config).size(), 3u);
  EXPECT_THROW(InstrumentTracker{config}, std::invalid_argument);
}

}  // namespace
}  // namespace laparoscope_servo::model
