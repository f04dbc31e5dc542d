// The tip's task error from messages: which instrument it keeps to, and everything that is not valid.
#include "ros/controller/tip_input.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

#include "unit/ros/controller/feature_inputs.h"

namespace laparoscope_servo {
namespace {

TrackedFeature tip(const std::string& number, double u, double v) {
  TrackedFeature feature;
  feature.id = number + " tip";
  feature.kind = TrackedFeature::POINT;
  feature.state = TrackedFeatures::TRACKING;
  feature.parameters = {u, v};
  feature.share = 0.9;
  feature.expected_error = 1.5;
  return feature;
}

TrackedFeatures of(const std::vector<TrackedFeature>& features) {
  TrackedFeatures message;
  message.width = 640;
  message.height = 480;
  message.features = features;
  return message;
}

TEST(TipInput, IsTheTipInNormalisedCoordinates) {
  TipInput input{servo::CentreTipConfig()};
  TrackedFeature pose = tip("1", 0.0, 0.0);
  pose.id = "1";
  pose.kind = TrackedFeature::POSE;
  const servo::TaskErrorInput seen = input.from(of({pose, tip("1", 360.0, 225.0)}), calibrated());
  ASSERT_TRUE(seen.valid) << seen.problem;
  EXPECT_EQ(seen.problem, "");
  EXPECT_NEAR(seen.error.x, 0.1, 1e-9);
  EXPECT_NEAR(seen.error.y, -0.05, 1e-9);
  EXPECT_EQ(seen.error.desired_x, 0.0);
  EXPECT_EQ(seen.visible_fraction, 0.9);
  EXPECT_EQ(seen.corner_error, 1.5);
  EXPECT_EQ(implausible(seen), "");
}

TEST(TipInput, KeepsToTheInstrumentThatWasNearest) {
  TipInput input{servo::CentreTipConfig()};
  const FeatureCamera camera = calibrated();
  const servo::TaskErrorInput first = input.from(of({tip("1", 500.0, 250.0), tip("2", 330.0, 250.0)}), camera);
  EXPECT_NEAR(first.error.x, 0.04, 1e-9);
  const servo::TaskErrorInput crossed = input.from(of({tip("1", 310.0, 250.0), tip("2", 400.0, 250.0)}), camera);
  EXPECT_NEAR(crossed.error.x, 0.18, 1e-9);
  EXPECT_EQ(crossed.region, first.region);
  EXPECT_FALSE(input.from(of({tip("1", 310.0, 250.0)}), camera).valid) << "it has left: no other one takes its place";
  input.release();
  const servo::TaskErrorInput other = input.from(of({tip("1", 310.0, 250.0)}), camera);
  EXPECT_TRUE(other.valid);
  EXPECT_NE(other.region, first.region);
}

TEST(TipInput, IsNotValidUnlessTheTipIsTracked) {
  const FeatureCamera camera = calibrated();
  for (const std::uint8_t state : {TrackedFeatures::IDLE, TrackedFeatures::SEARCHING, TrackedFeatures::LOST}) {
    TipInput input{servo::CentreTipConfig()};
    EXPECT_TRUE(input.from(of({tip("1", 310.0, 250.0)}), camera).valid);
    TrackedFeature lost = tip("1", 310.0, 250.0);
    lost.state = state;
    EXPECT_FALSE(input.from(of({lost}), camera).valid) << int{state};
  }
  TipInput input{servo::CentreTipConfig()};
  EXPECT_FALSE(input.from(of({}), camera).valid);
  for (const char* id : {"1", "tip", " tip", "1 left"}) {
    TrackedFeature none = tip("1", 310.0, 250.0);
    none.id = id;
    EXPECT_FALSE(input.from(of({none}), camera).valid) << id;
  }
  TrackedFeature line = tip("1", 310.0, 250.0);
  line.kind = TrackedFeature::LINE;
  EXPECT_FALSE(input.from(of({line}), camera).valid);
  TrackedFeature empty = tip("1", 310.0, 250.0);
  empty.parameters.clear();
  EXPECT_FALSE(input.from(of({empty}), camera).valid);
  TrackedFeature nan = tip("1", std::numeric_limits<double>::quiet_NaN(), 250.0);
  EXPECT_FALSE(input.from(of({nan}), camera).valid);
}

TEST(TipInput, RefusesATipOfImagesOfAnotherSizeThanTheCamera) {
  TipInput input{servo::CentreTipConfig()};
  TrackedFeatures message = of({tip("1", 310.0, 200.0)});
  message.height = 240;
  const servo::TaskErrorInput seen = input.from(message, calibrated());
  EXPECT_FALSE(seen.valid);
  EXPECT_EQ(seen.problem, "the tip is of images of another size than camera_info says");
  EXPECT_TRUE(input.from(of({tip("1", 310.0, 200.0)}), calibrated()).valid);
}

TEST(TipInput, NeedsACalibration) {
  TipInput input{servo::CentreTipConfig()};
  const servo::TaskErrorInput seen = input.from(of({tip("1", 310.0, 250.0)}), FeatureCamera(false));
  EXPECT_FALSE(seen.valid);
  EXPECT_NE(seen.problem.find("no camera_info has come"), std::string::npos);
}

}  // namespace
}  // namespace laparoscope_servo
