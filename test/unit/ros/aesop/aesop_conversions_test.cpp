#include "ros/aesop/aesop_conversions.h"

#include <gtest/gtest.h>

#include <map>

namespace laparoscope_servo {
namespace {

const aesop::Kinematics kKinematics{aesop::KinematicsConfig()};

aesop::Status someStatus() {
  aesop::Status status;
  status.position << 0.25, -0.8, 1.4, 0.1, 0.05, -0.08, 0.3;
  status.velocity << 0.003, 0.02, -0.03, 0.0, 0.01, -0.02, 0.05;
  return status;
}

Eigen::Isometry3d isometry(const geometry_msgs::Transform& t) {
  Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
  result.linear() = Eigen::Quaterniond(t.rotation.w, t.rotation.x, t.rotation.y, t.rotation.z).toRotationMatrix();
  result.translation() = Eigen::Vector3d(t.translation.x, t.translation.y, t.translation.z);
  return result;
}

TEST(AesopConversions, framesChainFromTheBaseToTheCamera) {
  const aesop::Status status = someStatus();
  std::vector<geometry_msgs::TransformStamped> all =
      linkTransforms(kKinematics, status.position, "left/", ros::Time(5.0));
  for (const auto& t :
       fixedTransforms(kKinematics, {0.5, 0.1, -0.2}, Eigen::Matrix3d::Identity(), "left/", ros::Time(5.0)))
    all.push_back(t);
  std::map<std::string, geometry_msgs::TransformStamped> parent;
  for (const auto& t : all) {
    EXPECT_EQ(t.header.stamp, ros::Time(5.0));
    EXPECT_TRUE(parent.emplace(t.child_frame_id, t).second) << "two parents of " << t.child_frame_id;
  }
  Eigen::Isometry3d base_T_optical = Eigen::Isometry3d::Identity();
  int links = 0;
  for (std::string frame = "left/laparoscope_optical"; frame != "left/aesop_base"; ++links) {
    ASSERT_EQ(parent.count(frame), 1u) << frame;
    base_T_optical = isometry(parent[frame].transform) * base_T_optical;
    frame = parent[frame].header.frame_id;
  }
  EXPECT_EQ(links, 9);
  EXPECT_TRUE(base_T_optical.isApprox(kKinematics.optical(status.position), 1e-9));
  EXPECT_EQ(parent["left/insertion_point"].header.frame_id, "left/aesop_base");
  EXPECT_DOUBLE_EQ(parent["left/insertion_point"].transform.translation.z, -0.2);
}

TEST(AesopConversions, obliqueOpticsTurnTheCameraOnTheTip) {
  const Eigen::Matrix3d optics = Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitX()).toRotationMatrix();
  for (const auto& t : fixedTransforms(kKinematics, {0.5, 0.1, -0.2}, optics, "", ros::Time(5.0))) {
    if (t.child_frame_id != "laparoscope_optical") continue;
    EXPECT_TRUE(isometry(t.transform).linear().isApprox(optics, 1e-12));
    EXPECT_EQ(isometry(t.transform).translation(), Eigen::Vector3d::Zero());
  }
  const aesop::Status status = someStatus();
  const geometry_msgs::Quaternion q = opticalPose(kKinematics, status, optics, "", ros::Time(5.0)).pose.orientation;
  EXPECT_TRUE(Eigen::Quaterniond(q.w, q.x, q.y, q.z)
                  .toRotationMatrix()
                  .isApprox(kKinematics.optical(status.position).linear() * optics, 1e-9));
}

TEST(AesopConversions, jointState) {
  const sensor_msgs::JointState message = jointState(someStatus(), ros::Time(5.0));
  ASSERT_EQ(message.name.size(), 7u);
  EXPECT_EQ(message.name[6], "joint_7");
  EXPECT_DOUBLE_EQ(message.position[6], 0.3);
  EXPECT_DOUBLE_EQ(message.velocity[1], 0.02);
}

TEST(AesopConversions, twistIsTheDerivativeOfThePose) {
  aesop::Status status = someStatus();
  const double dt = 1e-6;
  const geometry_msgs::TwistStamped twist = opticalTwist(kKinematics, status, "", ros::Time(5.0));
  const geometry_msgs::Point before =
      opticalPose(kKinematics, status, Eigen::Matrix3d::Identity(), "", ros::Time(5.0)).pose.position;
  status.position += dt * status.velocity;
  const geometry_msgs::Point after =
      opticalPose(kKinematics, status, Eigen::Matrix3d::Identity(), "", ros::Time(5.0)).pose.position;
  EXPECT_EQ(twist.header.frame_id, "aesop_base");
  EXPECT_NEAR(twist.twist.linear.x, (after.x - before.x) / dt, 1e-6);
  EXPECT_NEAR(twist.twist.linear.y, (after.y - before.y) / dt, 1e-6);
  EXPECT_NEAR(twist.twist.linear.z, (after.z - before.z) / dt, 1e-6);
}

TEST(AesopConversions, operatingState) {
  aesop::OperatingState state;
  state.mode = aesop::OperatingMode::kPaused;
  state.is_homed = true;
  state.reason = "why";
  const OperatingState message = toMessage(state, ros::Time(5.0));
  EXPECT_EQ(message.state, "PAUSED");
  EXPECT_TRUE(message.is_homed);
  EXPECT_FALSE(message.is_busy);
  EXPECT_EQ(message.reason, "why");
}

}  // namespace
}  // namespace laparoscope_servo
