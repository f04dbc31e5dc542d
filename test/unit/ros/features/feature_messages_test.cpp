#include "ros/features/feature_messages.h"

#include <gtest/gtest.h>

#include <cmath>

namespace laparoscope_servo {
namespace {

TEST(FeatureMessages, CopiesAllOfAFeature) {
  features::TrackedFeatures tracked;
  tracked.features.resize(2);
  features::TrackedFeature& line = tracked.features[0];
  line.id = "shaft";
  line.kind = features::FeatureKind::kLine;
  line.state = features::State::kTracking;
  line.parameters = Eigen::Vector2d(120.0, 0.3);
  line.covariance.resize(2, 2);
  line.covariance << 0.04, 0.001, 0.001, 0.0002;
  line.desired = Eigen::Vector2d(100.0, 0.0);
  line.share = 0.9;
  line.expected_error = 0.2;
  line.outline = {{10.0, 20.0}, {30.0, 40.0}};
  line.radius = 0.0025;
  features::TrackedFeature& rim = tracked.features[1];
  rim.id = "rim";
  rim.kind = features::FeatureKind::kEllipse;
  rim.state = features::State::kLost;
  rim.reason = "outside the image";
  features::setUnknown(rim.covariance, 5);
  features::summarise(tracked, "");
  std_msgs::Header header;
  header.frame_id = "optical";
  header.stamp = ros::Time(7, 8);

  const TrackedFeatures message = featuresMessage(header, {640, 480}, tracked, ros::Time(3, 4));
  EXPECT_EQ(message.header.frame_id, "optical");
  EXPECT_EQ(message.header.stamp, ros::Time(7, 8));
  EXPECT_EQ(message.width, 640u);
  EXPECT_EQ(message.height, 480u);
  EXPECT_EQ(message.selection_stamp, ros::Time(3, 4));
  EXPECT_EQ(message.state, TrackedFeatures::LOST);
  EXPECT_EQ(message.reason, "rim: outside the image");
  ASSERT_EQ(message.features.size(), 2u);
  const TrackedFeature& first = message.features[0];
  EXPECT_EQ(first.id, "shaft");
  EXPECT_EQ(first.kind, TrackedFeature::LINE);
  EXPECT_EQ(first.state, TrackedFeatures::TRACKING);
  EXPECT_EQ(first.reason, "");
  EXPECT_EQ(first.parameters, (std::vector<double>{120.0, 0.3}));
  EXPECT_EQ(first.covariance, (std::vector<double>{0.04, 0.001, 0.001, 0.0002}));
  EXPECT_EQ(first.desired, (std::vector<double>{100.0, 0.0}));
  EXPECT_EQ(first.share, 0.9);
  EXPECT_EQ(first.expected_error, 0.2);
  EXPECT_EQ(first.outline, (std::vector<double>{10.0, 20.0, 30.0, 40.0}));
  EXPECT_EQ(first.radius, 0.0025);
  const TrackedFeature& second = message.features[1];
  EXPECT_EQ(second.kind, TrackedFeature::ELLIPSE);
  EXPECT_EQ(second.reason, "outside the image");
  EXPECT_TRUE(second.parameters.empty());
  ASSERT_EQ(second.covariance.size(), 25u);
  EXPECT_TRUE(std::isinf(second.covariance[6]));
  EXPECT_EQ(second.covariance[1], 0.0);
}

TEST(FeatureMessages, SaysThatNothingIsSelected) {
  features::TrackedFeatures tracked;
  features::summarise(tracked, "nothing is selected");
  const TrackedFeatures message = featuresMessage({}, {640, 480}, tracked);
  EXPECT_EQ(message.state, TrackedFeatures::IDLE);
  EXPECT_EQ(message.reason, "nothing is selected");
  EXPECT_TRUE(message.features.empty());
}

}  // namespace
}  // namespace laparoscope_servo
