#include "ros/features/feature_messages.h"

namespace laparoscope_servo {

namespace {

using features::FeatureKind;
using features::State;

constexpr bool isSame(FeatureKind kind, std::uint8_t constant) {
  return static_cast<std::uint8_t>(kind) == constant;
}

constexpr bool isSame(State state, std::uint8_t constant) {
  return static_cast<std::uint8_t>(state) == constant;
}

static_assert(isSame(FeatureKind::kPoint, TrackedFeature::POINT));
static_assert(isSame(FeatureKind::kLine, TrackedFeature::LINE));
static_assert(isSame(FeatureKind::kEllipse, TrackedFeature::ELLIPSE));
static_assert(isSame(FeatureKind::kSpline, TrackedFeature::SPLINE));
static_assert(isSame(FeatureKind::kPose, TrackedFeature::POSE));
static_assert(isSame(FeatureKind::kMotion, TrackedFeature::MOTION));
static_assert(isSame(FeatureKind::kHomography, TrackedFeature::HOMOGRAPHY));
static_assert(isSame(State::kIdle, TrackedFeatures::IDLE));
static_assert(isSame(State::kTracking, TrackedFeatures::TRACKING));
static_assert(isSame(State::kSearching, TrackedFeatures::SEARCHING));
static_assert(isSame(State::kLost, TrackedFeatures::LOST));

std::vector<double> numbers(const Eigen::VectorXd& vector) {
  return {vector.data(), vector.data() + vector.size()};
}

TrackedFeature featureMessage(const features::TrackedFeature& feature) {
  TrackedFeature message;
  message.id = feature.id;
  message.kind = static_cast<std::uint8_t>(feature.kind);
  message.state = static_cast<std::uint8_t>(feature.state);
  message.reason = feature.reason;
  message.parameters = numbers(feature.parameters);
  // Symmetric, so that the order of rows and columns does not matter.
  message.covariance.assign(feature.covariance.data(), feature.covariance.data() + feature.covariance.size());
  message.desired = numbers(feature.desired);
  message.share = feature.share;
  message.expected_error = feature.expected_error;
  message.radius = feature.radius;
  message.outline.reserve(2 * feature.outline.size());
  for (const Eigen::Vector2d& point : feature.outline) {
    message.outline.push_back(point.x());
    message.outline.push_back(point.y());
  }
  return message;
}

}  // namespace

TrackedFeatures featuresMessage(const std_msgs::Header& header, const cv::Size& size,
                                const features::TrackedFeatures& tracked, const ros::Time& selected) {
  TrackedFeatures message;
  message.header = header;
  message.width = static_cast<std::uint32_t>(size.width);
  message.height = static_cast<std::uint32_t>(size.height);
  message.selection_stamp = selected;
  message.state = static_cast<std::uint8_t>(tracked.state);
  message.reason = tracked.reason;
  message.features.reserve(tracked.features.size());
  for (const features::TrackedFeature& feature : tracked.features) message.features.push_back(featureMessage(feature));
  return message;
}

}  // namespace laparoscope_servo
