// The error of points from messages: its convention, which points count, and everything that is refused by name.
#include "ros/controller/points_input.h"

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <string>

#include "unit/ros/controller/feature_inputs.h"

namespace laparoscope_servo {
namespace {

// 16 points, all seen (u, v) px away from where they shall be.
TrackedFeatures pointsOff(double u, double v) {
  TrackedFeatures message;
  message.width = 640;
  message.height = 480;
  message.selection_stamp = ros::Time(3.0);
  for (int k = 0; k < 16; ++k) {
    TrackedFeature point;
    point.id = "tissue " + std::to_string(k + 1);
    point.kind = TrackedFeature::POINT;
    point.state = TrackedFeatures::TRACKING;
    point.desired = {250.0 + 40.0 * (k % 4), 190.0 + 40.0 * (k / 4)};
    point.parameters = {point.desired[0] + u, point.desired[1] + v};
    message.features.push_back(point);
  }
  return message;
}

PointsInput input() {
  return PointsInput(servo::PointsConfig(), 0.08);
}

TEST(PointsInput, IsWhereTheMiddleOfThePointsIs) {
  PointsInput points = input();
  const servo::TaskErrorInput seen = points.from(pointsOff(50.0, -25.0), calibrated(), depthOf(0.1));
  ASSERT_TRUE(seen.valid) << seen.problem;
  EXPECT_NEAR(seen.error.x - seen.error.desired_x, 0.1, 0.005);
  EXPECT_NEAR(seen.error.y - seen.error.desired_y, -0.05, 0.005);
  EXPECT_NEAR(seen.error.desired_y, 0.0, 1e-9);
  EXPECT_NEAR(seen.error.alpha, 0.0, 0.02);
  EXPECT_NEAR(seen.error.log_depth, 0.0, 0.02);
  EXPECT_EQ(seen.region, 3.0);
  EXPECT_EQ(implausible(seen), "");
}

TEST(PointsInput, PointsThatAreNotSeenOrAstrayHaveNoSay) {
  PointsInput points = input();
  TrackedFeatures message = pointsOff(50.0, -25.0);
  const servo::TaskErrorInput all = points.from(message, calibrated(), depthOf(0.1));
  for (int k = 0; k < 3; ++k) {
    message.features[4 * k].state = TrackedFeatures::SEARCHING;
    message.features[4 * k].parameters = {0.0, 0.0};
    message.features[4 * k + 1].parameters = {500.0, 10.0 * k};
  }
  const servo::TaskErrorInput part = points.from(message, calibrated(), depthOf(0.1));
  ASSERT_TRUE(part.valid) << part.problem;
  EXPECT_NEAR(part.error.x, all.error.x, 2e-3);
  EXPECT_NEAR(part.error.y, all.error.y, 2e-3);
  EXPECT_EQ(part.error.m_star, all.error.m_star) << "else another region would seem selected";
  EXPECT_LE(part.visible_fraction, 10.0 / 16.0);
}

// Else repeat_watch.h would not see that a picture repeats.
TEST(PointsInput, TheSamePictureHasTheSameDigitsWhateverThePose) {
  PointsInput points = input();
  const servo::TaskErrorInput first = points.from(pointsOff(50.0, -25.0), calibrated(), depthOf(0.1));
  const servo::TaskErrorInput second = points.from(pointsOff(50.0, -25.0), calibrated(), depthOf(0.1003));
  EXPECT_EQ(first.error.x, second.error.x);
  EXPECT_EQ(first.error.alpha, second.error.alpha);
}

TEST(PointsInput, WhatCannotBeUsedIsRefusedByName) {
  struct Case {
    const char* name;
    std::function<void(TrackedFeatures&)> apply;
    const char* problem;
  };
  const Case cases[] = {
      {"nothing", [](TrackedFeatures& m) { m.features.clear(); }, "points/min_points"},
      {"no desired places",
       [](TrackedFeatures& m) {
         for (auto& f : m.features) f.desired.clear();
       },
       "min_points"},
      {"no points",
       [](TrackedFeatures& m) {
         for (auto& f : m.features) f.kind = TrackedFeature::LINE;
       },
       "min_points"},
      {"another size", [](TrackedFeatures& m) { m.height = 240; }, "another size"},
  };
  for (const Case& c : cases) {
    PointsInput points = input();
    TrackedFeatures message = pointsOff(10.0, 0.0);
    c.apply(message);
    const servo::TaskErrorInput seen = points.from(message, calibrated(), depthOf(0.1));
    EXPECT_FALSE(seen.valid) << c.name;
    EXPECT_NE(seen.problem.find(c.problem), std::string::npos) << c.name << ": " << seen.problem;
  }
  PointsInput points = input();
  EXPECT_NE(points.from(pointsOff(1.0, 0.0), FeatureCamera(false), depthOf(0.1)).problem.find("camera_info"),
            std::string::npos);
  EXPECT_EQ(points.from(pointsOff(1.0, 0.0), calibrated(), servo::DepthInput()).problem, "depth d2 is unknown");
  TrackedFeatures lost = pointsOff(1.0, 0.0);
  for (TrackedFeature& point : lost.features) point.state = TrackedFeatures::LOST;
  const servo::TaskErrorInput seen = points.from(lost, calibrated(), depthOf(0.1));
  EXPECT_FALSE(seen.valid);
  EXPECT_EQ(seen.problem, "");
  for (TrackedFeature& point : lost.features) {
    point.state = TrackedFeatures::TRACKING;
    point.parameters[0] = std::numeric_limits<double>::quiet_NaN();
  }
  EXPECT_FALSE(points.from(lost, calibrated(), depthOf(0.1)).valid);
}

}  // namespace
}  // namespace laparoscope_servo
