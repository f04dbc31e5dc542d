#include "ros/aesop/aesop_conversions.h"

#include "laparoscope_servo/geometry/se3.h"
#include "ros/common/eigen_messages.h"

namespace laparoscope_servo {

namespace {

geometry_msgs::TransformStamped transform(const std::string& parent, const std::string& child,
                                          const Eigen::Isometry3d& t, const ros::Time& stamp) {
  geometry_msgs::TransformStamped message;
  message.header.stamp = stamp;
  message.header.frame_id = parent;
  message.child_frame_id = child;
  message.transform = transformMessage(t);
  return message;
}

std::string linkName(int k) {
  return k == aesop::kJoints ? "end_effector" : "link_" + std::to_string(k);
}

}  // namespace

scope::Velocity fromMessage(const ScopeVelocity& message) {
  return {message.pan, message.tilt, message.spin, message.insertion};
}

OperatingState toMessage(const aesop::OperatingState& state, const ros::Time& stamp) {
  OperatingState message;
  message.header.stamp = stamp;
  message.state = aesop::name(state.mode);
  message.is_homed = state.is_homed;
  message.is_busy = state.is_busy;
  message.reason = state.reason;
  return message;
}

sensor_msgs::JointState jointState(const aesop::Status& status, const ros::Time& stamp) {
  sensor_msgs::JointState message;
  message.header.stamp = stamp;
  for (int k = 0; k < aesop::kJoints; ++k) {
    message.name.push_back("joint_" + std::to_string(k + 1));
    message.position.push_back(status.position[k]);
    message.velocity.push_back(status.velocity[k]);
  }
  return message;
}

geometry_msgs::PoseStamped opticalPose(const aesop::Kinematics& kinematics, const aesop::Status& status,
                                       const Eigen::Matrix3d& tip_R_optical, const std::string& prefix,
                                       const ros::Time& stamp) {
  const Eigen::Isometry3d base_T_optical = kinematics.optical(status.position);
  geometry_msgs::PoseStamped message;
  message.header.stamp = stamp;
  message.header.frame_id = prefix + "aesop_base";
  message.pose.position = pointMessage(base_T_optical.translation());
  message.pose.orientation = rotationMessage(base_T_optical.linear() * tip_R_optical);
  return message;
}

geometry_msgs::TwistStamped opticalTwist(const aesop::Kinematics& kinematics, const aesop::Status& status,
                                         const std::string& prefix, const ros::Time& stamp) {
  const geometry::Vector6d twist = kinematics.jacobian(status.position) * status.velocity;
  const Eigen::Vector3d w = twist.tail<3>();
  const Eigen::Vector3d lever =
      kinematics.optical(status.position).translation() - kinematics.endEffector(status.position).translation();
  geometry_msgs::TwistStamped message;
  message.header.stamp = stamp;
  message.header.frame_id = prefix + "aesop_base";
  message.twist.linear = vectorMessage(twist.head<3>() + w.cross(lever));
  message.twist.angular = vectorMessage(w);
  return message;
}

std::vector<geometry_msgs::TransformStamped> linkTransforms(const aesop::Kinematics& kinematics,
                                                            const aesop::JointVector& q, const std::string& prefix,
                                                            const ros::Time& stamp) {
  const auto frames = kinematics.linkFrames(q);
  std::vector<geometry_msgs::TransformStamped> transforms;
  for (int k = 1; k <= aesop::kJoints; ++k) {
    const auto index = static_cast<std::size_t>(k);
    const std::string parent = k == 1 ? "aesop_base" : linkName(k - 1);
    transforms.push_back(
        transform(prefix + parent, prefix + linkName(k), frames[index - 1].inverse() * frames[index], stamp));
  }
  return transforms;
}

std::vector<geometry_msgs::TransformStamped> fixedTransforms(const aesop::Kinematics& kinematics,
                                                             const Eigen::Vector3d& insertion_point,
                                                             const Eigen::Matrix3d& tip_R_optical,
                                                             const std::string& prefix, const ros::Time& stamp) {
  Eigen::Isometry3d tip_T_optical = Eigen::Isometry3d::Identity();
  tip_T_optical.linear() = tip_R_optical;
  return {transform(prefix + "end_effector", prefix + "scope_tip", kinematics.opticalInEndEffector(), stamp),
          transform(prefix + "scope_tip", prefix + "laparoscope_optical", tip_T_optical, stamp),
          transform(prefix + "aesop_base", prefix + "insertion_point",
                    Eigen::Isometry3d(Eigen::Translation3d(insertion_point)), stamp)};
}

}  // namespace laparoscope_servo
