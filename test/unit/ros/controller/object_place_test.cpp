// The object's place from messages: its convention, what ends it, and everything that is refused by name.
#include "ros/controller/object_place.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <string>

#include "unit/ros/controller/feature_inputs.h"

namespace laparoscope_servo {
namespace {

// An object of 60 x 40 px whose middle is at (u, v), `k` images after it was selected.
TrackedFeatures objectAt(double u, double v, int k, double error = 0.03) {
  TrackedFeatures message;
  message.width = 640;
  message.height = 480;
  message.selection_stamp = ros::Time(3.0);
  message.header.stamp = ros::Time(3.0 + 0.04 * k);
  TrackedFeature motion;
  motion.id = "swab";
  motion.kind = TrackedFeature::MOTION;
  motion.state = k == 0 ? TrackedFeatures::SEARCHING : TrackedFeatures::TRACKING;
  motion.share = 0.8;
  motion.expected_error = k == 0 ? std::numeric_limits<double>::infinity() : error;
  motion.parameters = {1.0, 0.0};
  motion.outline = {u - 30, v - 20, u + 30, v - 20, u + 30, v + 20, u - 30, v + 20, u - 30, v - 20};
  message.features = {motion};
  return message;
}

TEST(ObjectPlace, IsTheMiddleOfTheRegionInNormalisedCoordinates) {
  servo::FollowConfig config;
  config.x = 0.05;
  ObjectPlace place(config);
  EXPECT_TRUE(place.from(objectAt(310.0, 250.0, 0), calibrated()).valid) << "nothing has moved since the selection";
  const servo::TaskErrorInput seen = place.from(objectAt(360.0, 225.0, 1), calibrated());
  ASSERT_TRUE(seen.valid) << seen.problem;
  EXPECT_NEAR(seen.error.x, 0.1, 1e-9);
  EXPECT_NEAR(seen.error.y, -0.05, 1e-9);
  EXPECT_EQ(seen.error.desired_x, 0.05);
  EXPECT_EQ(seen.region, 3.0);
  EXPECT_EQ(seen.visible_fraction, 0.8);
  EXPECT_EQ(implausible(seen), "");
}

TEST(ObjectPlace, ItsErrorGrowsFromTheSelectionOn) {
  ObjectPlace place{servo::FollowConfig()};
  servo::TaskErrorInput seen;
  for (int k = 0; k <= 100; ++k) seen = place.from(objectAt(310.0, 250.0, k), calibrated());
  EXPECT_NEAR(seen.corner_error, 0.03 * std::sqrt(100.0), 1e-9);
  TrackedFeatures again = objectAt(310.0, 250.0, 1);
  again.selection_stamp = ros::Time(9.0);
  EXPECT_NEAR(place.from(again, calibrated()).corner_error, 0.03, 1e-9);
}

// The region may lie on the tissue behind it by then.
TEST(ObjectPlace, OnceLostItHasToBeSelectedAgain) {
  ObjectPlace place{servo::FollowConfig()};
  ASSERT_TRUE(place.from(objectAt(310.0, 250.0, 1), calibrated()).valid);
  TrackedFeatures lost = objectAt(310.0, 250.0, 2);
  lost.features[0].state = TrackedFeatures::SEARCHING;
  EXPECT_NE(place.from(lost, calibrated()).problem.find("the object was lost"), std::string::npos);
  EXPECT_FALSE(place.from(objectAt(310.0, 250.0, 3), calibrated()).valid);
  TrackedFeatures again = objectAt(310.0, 250.0, 4);
  again.selection_stamp = ros::Time(9.0);
  EXPECT_TRUE(place.from(again, calibrated()).valid);
}

TEST(ObjectPlace, WhatCannotBeFollowedIsRefusedByName) {
  struct Case {
    const char* name;
    std::function<void(TrackedFeatures&)> apply;
    const char* problem;
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Case cases[] = {
      {"nothing", [](TrackedFeatures& m) { m.features.clear(); }, "no object was selected"},
      {"nobody selected", [](TrackedFeatures& m) { m.selection_stamp = ros::Time(); }, "no object was selected"},
      {"the whole view", [](TrackedFeatures& m) { m.features.push_back(m.features[0]); }, "no object was selected"},
      {"no outline", [](TrackedFeatures& m) { m.features[0].outline.resize(7); }, "no object was selected"},
      {"a point", [](TrackedFeatures& m) { m.features[0].kind = TrackedFeature::POINT; }, "no object was selected"},
      {"another size", [](TrackedFeatures& m) { m.width = 320; }, "another size"},
      {"outside",
       [](TrackedFeatures& m) {
         for (double& p : m.features[0].outline) p += 600.0;
       },
       "the object leaves"},
      {"not a number", [&](TrackedFeatures& m) { m.features[0].outline[3] = nan; }, "the object leaves"},
  };
  for (const Case& c : cases) {
    ObjectPlace place{servo::FollowConfig()};
    TrackedFeatures message = objectAt(310.0, 250.0, 1);
    c.apply(message);
    const servo::TaskErrorInput seen = place.from(message, calibrated());
    EXPECT_FALSE(seen.valid) << c.name;
    EXPECT_NE(seen.problem.find(c.problem), std::string::npos) << c.name << ": " << seen.problem;
  }
  ObjectPlace place{servo::FollowConfig()};
  EXPECT_NE(place.from(objectAt(310.0, 250.0, 1), FeatureCamera(false)).problem.find("camera_info"), std::string::npos);
}

}  // namespace
}  // namespace laparoscope_servo
