#include "ros/features/pose_publisher.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "laparoscope_servo/geometry/se3.h"
#include "ros/common/eigen_messages.h"

namespace laparoscope_servo {

namespace {

bool isSeenPose(const features::TrackedFeature& feature) {
  return feature.kind == features::FeatureKind::kPose && feature.state == features::State::kTracking;
}

Eigen::Isometry3d poseOf(const features::TrackedFeature& feature) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = feature.parameters.head<3>();
  pose.linear() = geometry::so3Exp(feature.parameters.tail<3>());
  return pose;
}

bool isPlain(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
}

}  // namespace

std::string poseFrame(const std::string& node, const std::string& id) {
  std::string name = id;
  std::replace_if(
      name.begin(), name.end(), [](char c) { return !isPlain(c); }, '_');
  return node.substr(std::min(node.find_first_not_of('/'), node.size())) + "/" + name;
}

geometry_msgs::PoseWithCovarianceStamped poseMessage(const std_msgs::Header& header,
                                                     const features::TrackedFeature& feature) {
  geometry_msgs::PoseWithCovarianceStamped message;
  message.header = header;
  const Eigen::Isometry3d pose = poseOf(feature);
  message.pose.pose.position = pointMessage(pose.translation());
  message.pose.pose.orientation = rotationMessage(pose.linear());
  // Symmetric, so that the order of rows and columns does not matter.
  std::copy_n(feature.covariance.data(), message.pose.covariance.size(), message.pose.covariance.begin());
  return message;
}

std::vector<geometry_msgs::TransformStamped> poseTransforms(const std_msgs::Header& header,
                                                            const features::TrackedFeatures& features,
                                                            const std::string& node) {
  std::vector<geometry_msgs::TransformStamped> transforms;
  if (header.frame_id.empty()) return transforms;
  for (const features::TrackedFeature& feature : features.features) {
    if (!isSeenPose(feature)) continue;
    geometry_msgs::TransformStamped message;
    message.header = header;
    message.child_frame_id = poseFrame(node, feature.id);
    message.transform = transformMessage(poseOf(feature));
    const bool is_new = std::none_of(transforms.begin(), transforms.end(), [&message](const auto& other) {
      return other.child_frame_id == message.child_frame_id;
    });
    if (is_new) transforms.push_back(message);
  }
  return transforms;
}

PosePublisher::PosePublisher(ros::NodeHandle& node, bool publish_tf)
    : node_(node.getNamespace()), publisher_(node.advertise<geometry_msgs::PoseWithCovarianceStamped>("pose", 10)) {
  if (publish_tf) broadcaster_.emplace();
}

void PosePublisher::publish(const std_msgs::Header& header, const features::TrackedFeatures& features) {
  const auto first = std::find_if(features.features.begin(), features.features.end(), isSeenPose);
  if (first == features.features.end()) return;
  publisher_.publish(poseMessage(header, *first));
  if (!broadcaster_) return;
  const std::vector<geometry_msgs::TransformStamped> transforms = poseTransforms(header, features, node_);
  if (!transforms.empty()) broadcaster_->sendTransform(transforms);
}

}  // namespace laparoscope_servo
