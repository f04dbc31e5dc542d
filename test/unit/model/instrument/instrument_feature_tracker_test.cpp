#include "laparoscope_servo/model/instrument_feature_tracker.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "support/instrument_scene.h"

namespace laparoscope_servo::model {
namespace {

using features::FeatureKind;
using features::State;
using features::TrackedFeature;
using features::TrackedFeatures;
using test_support::instrumentScene;

constexpr double kPeriod = 0.04;  // s

const TrackedFeature* find(const TrackedFeatures& told, const std::string& id) {
  for (const TrackedFeature& feature : told.features) {
    if (feature.id == id) return &feature;
  }
  return nullptr;
}

class InstrumentFeatures : public testing::Test {
 protected:
  const TrackedFeatures& next(bool empty = false) {
    ++image_;
    return tracker_.track(instrumentScene(0.5 * image_, static_cast<unsigned>(image_), empty), kPeriod * image_,
                          prior_);
  }
  // Until the instrument is believed.
  const TrackedFeatures& start() {
    for (int k = 0; k < 7; ++k) next();
    return tracker_.features();
  }

  InstrumentFeatureTracker tracker_;
  features::FeaturePrior prior_;
  int image_ = 0;
};

TEST_F(InstrumentFeatures, TellsEdgesAndTip) {
  EXPECT_EQ(tracker_.features().reason, "no instrument is seen");
  EXPECT_TRUE(tracker_.mask().empty());
  const TrackedFeatures& told = start();
  ASSERT_EQ(told.state, State::kTracking) << told.reason;
  const Eigen::Vector2d tip = test_support::shaftTip(0.5 * image_);
  for (const char* id : {"1 right", "1 left"}) {
    const TrackedFeature* edge = find(told, id);
    ASSERT_NE(edge, nullptr) << id;
    EXPECT_EQ(edge->kind, FeatureKind::kLine);
    const Eigen::Vector2d normal(std::cos(edge->parameters[1]), std::sin(edge->parameters[1]));
    EXPECT_NEAR(normal.dot(tip) - edge->parameters[0], -test_support::kShaftHalfWidth, 1.0) << id;
    EXPECT_GT(edge->covariance(0, 0), 0.0);
    EXPECT_TRUE(std::isfinite(edge->expected_error));
    EXPECT_EQ(edge->outline.size(), 2u);
    EXPECT_EQ(edge->sites.empty(), edge->share == 0.0) << "sites are those of the fit to the image's edges";
    for (const features::TrackedSite& site : edge->sites)
      EXPECT_NEAR(normal.dot(site.point), edge->parameters[0], 0.5) << id;
  }
  const TrackedFeature* point = find(told, "1 tip");
  ASSERT_NE(point, nullptr);
  EXPECT_EQ(point->kind, FeatureKind::kPoint);
  EXPECT_NEAR((point->parameters - tip).norm(), 0.0, 20.0);
  EXPECT_EQ(find(told, "1"), nullptr) << "a pose without a radius";
  EXPECT_EQ(tracker_.mask().size(), cv::Size(320, 240));
  EXPECT_EQ(tracker_.mask().at<std::uint8_t>(static_cast<int>(tip.y()) - 12, static_cast<int>(tip.x()) - 30), 255);
  EXPECT_EQ(tracker_.mask().at<std::uint8_t>(20, 300), 0);
}

TEST_F(InstrumentFeatures, TellsThePoseWhereRadiusAndCameraAreKnown) {
  InstrumentConfig config;
  config.radius = 0.0025;
  tracker_ = InstrumentFeatureTracker(config);
  prior_.camera = geometry::PinholeCamera{300.0, 300.0, 160.0, 120.0};
  const TrackedFeature* pose = find(start(), "1");
  ASSERT_NE(pose, nullptr);
  EXPECT_EQ(pose->kind, FeatureKind::kPose);
  EXPECT_EQ(pose->radius, 0.0025);
  ASSERT_EQ(pose->parameters.size(), 6);
  EXPECT_EQ(pose->covariance.rows(), 6);
  // 32 px wide at 300 px focal length: 5 mm are about 47 mm away.
  EXPECT_NEAR(pose->parameters[2], 0.047, 0.005);
  // The z axis goes along the shaft.
  const Eigen::Vector3d turn = pose->parameters.tail<3>();
  const Eigen::Vector3d z = Eigen::AngleAxisd(turn.norm(), turn.normalized()) * Eigen::Vector3d::UnitZ();
  EXPECT_GT(z.dot(Eigen::Vector3d(0.9, 0.35, 0.0).normalized()), 0.95);
}

TEST_F(InstrumentFeatures, IsUncertainWhenItIsNotSeen) {
  start();
  const TrackedFeatures& told = next(true);
  ASSERT_FALSE(told.features.empty());
  EXPECT_EQ(told.state, State::kSearching);
  EXPECT_FALSE(told.reason.empty());
  for (const TrackedFeature& feature : told.features) {
    EXPECT_TRUE(std::isinf(feature.expected_error)) << feature.id;
    EXPECT_TRUE(std::isinf(feature.covariance(0, 0))) << feature.id;
  }
}

TEST_F(InstrumentFeatures, ForgetsAndFindsAgain) {
  start();
  tracker_.reset();
  EXPECT_EQ(tracker_.features().state, State::kIdle);
  EXPECT_EQ(tracker_.features().reason, "reset");
  EXPECT_EQ(start().state, State::kTracking);
}

TEST_F(InstrumentFeatures, RefusesASelectionAndAnImageWithoutColour) {
  EXPECT_TRUE(tracker_.findsByItself());
  start();
  const cv::Mat image = instrumentScene(0.0, 1);
  EXPECT_THROW(tracker_.select(image, 1.0, features::FeatureSelection(1), {}), std::invalid_argument);
  EXPECT_THROW(tracker_.track(cv::Mat(240, 320, CV_8UC1, cv::Scalar(90)), 1.0, {}), std::invalid_argument);
  EXPECT_EQ(next().state, State::kTracking);
}

}  // namespace
}  // namespace laparoscope_servo::model
