// The messages; that they are published is shown by the test model_nodelet.
#include "ros/features/pose_publisher.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include "laparoscope_servo/geometry/se3.h"

namespace laparoscope_servo {
namespace {

features::TrackedFeature pose() {
  features::TrackedFeature feature;
  feature.id = "1";
  feature.kind = features::FeatureKind::kPose;
  feature.state = features::State::kTracking;
  feature.parameters.resize(6);
  feature.parameters << 0.01, -0.02, 0.1, 0.3, -1.2, 0.5;
  feature.covariance.setIdentity(6, 6);
  feature.covariance(0, 5) = feature.covariance(5, 0) = 0.25;
  feature.covariance(2, 2) = 7.0;
  return feature;
}

std_msgs::Header header() {
  std_msgs::Header header;
  header.frame_id = "optical";
  header.stamp = ros::Time(7, 8);
  return header;
}

TEST(PosePublisher, TellsThePoseWithItsCovariance) {
  const geometry_msgs::PoseWithCovarianceStamped message = poseMessage(header(), pose());
  EXPECT_EQ(message.header.frame_id, "optical");
  EXPECT_EQ(message.header.stamp, ros::Time(7, 8));
  EXPECT_EQ(message.pose.pose.position.y, -0.02);
  const geometry_msgs::Quaternion& q = message.pose.pose.orientation;
  const Eigen::Matrix3d rotation = Eigen::Quaterniond(q.w, q.x, q.y, q.z).toRotationMatrix();
  EXPECT_LT((rotation - geometry::so3Exp({0.3, -1.2, 0.5})).norm(), 1e-12);
  EXPECT_EQ(message.pose.covariance[5], 0.25);
  EXPECT_EQ(message.pose.covariance[30], 0.25);
  EXPECT_EQ(message.pose.covariance[14], 7.0);
}

// The order and the axes of geometry_msgs/PoseWithCovariance: x, y, z, and rotations about the fixed axes x, y, z.
// Poses are moved by known motions of that kind; what the messages of the moved poses show of each motion has to have
// the covariance that the message of the unmoved one tells.
TEST(PosePublisher, TheCovarianceIsOfTranslationThenRotationAboutFixedAxes) {
  geometry::Matrix6d root;
  cv::RNG random(3);
  for (Eigen::Index k = 0; k < 36; ++k) root.data()[k] = random.gaussian(1.0);
  features::TrackedFeature feature = pose();
  feature.covariance = root * root.transpose();
  const auto isometryOf = [](const geometry_msgs::Pose& message) {
    const geometry_msgs::Quaternion& q = message.orientation;
    Eigen::Isometry3d result(Eigen::Quaterniond(q.w, q.x, q.y, q.z));
    result.translation() = Eigen::Vector3d(message.position.x, message.position.y, message.position.z);
    return result;
  };
  const geometry_msgs::PoseWithCovarianceStamped message = poseMessage(header(), feature);
  const Eigen::Isometry3d before = isometryOf(message.pose.pose);
  constexpr double kStep = 1e-6;
  geometry::Matrix6d told = geometry::Matrix6d::Zero();
  for (Eigen::Index k = 0; k < 6; ++k) {
    const geometry::Vector6d motion = kStep * root.col(k);
    features::TrackedFeature moved = feature;
    moved.parameters.head<3>() += motion.head<3>();
    moved.parameters.tail<3>() =
        geometry::so3Log(geometry::so3Exp(motion.tail<3>()) * geometry::so3Exp(feature.parameters.tail<3>()));
    const Eigen::Isometry3d after = isometryOf(poseMessage(header(), moved).pose.pose);
    geometry::Vector6d seen;
    seen << after.translation() - before.translation(), geometry::so3Log(after.linear() * before.linear().transpose());
    told += seen * seen.transpose() / (kStep * kStep);
  }
  const Eigen::Map<const Eigen::Matrix<double, 6, 6, Eigen::RowMajor>> covariance(message.pose.covariance.data());
  EXPECT_LT((covariance - told).norm(), 1e-4 * told.norm());
}

TEST(PosePublisher, TheTransformIsThatOfThePose) {
  features::TrackedFeatures features;
  features.features = {pose()};
  const auto transforms = poseTransforms(header(), features, "/left/model");
  ASSERT_EQ(transforms.size(), 1u);
  EXPECT_EQ(transforms[0].header.frame_id, "optical");
  EXPECT_EQ(transforms[0].header.stamp, ros::Time(7, 8));
  EXPECT_EQ(transforms[0].child_frame_id, "left/model/1");
  EXPECT_EQ(transforms[0].transform.translation.z, 0.1);
  EXPECT_EQ(transforms[0].transform.rotation.w, poseMessage(header(), pose()).pose.pose.orientation.w);
}

TEST(PosePublisher, OnlyWhatIsSeenHasATransformAndEachFrameOnce) {
  features::TrackedFeatures features;
  features.features.assign(4, pose());
  features.features[0].state = features::State::kSearching;
  features.features[1].id = "a b";
  features.features[2].id = "a_b";
  features.features[2].parameters.setZero(6);
  features.features[3].kind = features::FeatureKind::kLine;
  const auto transforms = poseTransforms(header(), features, "/model");
  ASSERT_EQ(transforms.size(), 1u);
  EXPECT_EQ(transforms[0].child_frame_id, "model/a_b");
  EXPECT_EQ(transforms[0].transform.translation.z, 0.1) << "that of the first one";
  EXPECT_TRUE(poseTransforms(std_msgs::Header(), features, "/model").empty()) << "the image has no frame";
}

TEST(PosePublisher, EachObjectOfEachNodeHasAFrameOfItsOwn) {
  EXPECT_EQ(poseFrame("/model", "clamp"), "model/clamp");
  EXPECT_EQ(poseFrame("/left/model", "clamp"), "left/model/clamp");
  EXPECT_EQ(poseFrame("/left/instrument", "1"), "left/instrument/1");
  EXPECT_EQ(poseFrame("/model", "a clamp/<b>"), "model/a_clamp__b_");
  EXPECT_NE(poseFrame("/model_a", "b"), poseFrame("/model", "a_b"));
}

}  // namespace
}  // namespace laparoscope_servo
