// Converts core types to messages of the aesop node.
#pragma once

#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/TransformStamped.h>
#include <geometry_msgs/TwistStamped.h>
#include <sensor_msgs/JointState.h>

#include <vector>

#include "laparoscope_servo/OperatingState.h"
#include "laparoscope_servo/ScopeVelocity.h"
#include "laparoscope_servo/aesop/driver.h"

namespace laparoscope_servo {

scope::Velocity fromMessage(const ScopeVelocity& message);
OperatingState toMessage(const aesop::OperatingState& state, const ros::Time& stamp);

// joint_1 to joint_7: m and m/s of prismatic joints, rad and rad/s of the others.
sensor_msgs::JointState jointState(const aesop::Status& status, const ros::Time& stamp);
// Pose of laparoscope_optical in aesop_base. `tip_R_optical`: the optics, identity for 0 degrees.
geometry_msgs::PoseStamped opticalPose(const aesop::Kinematics& kinematics, const aesop::Status& status,
                                       const Eigen::Matrix3d& tip_R_optical, const std::string& prefix,
                                       const ros::Time& stamp);
// Velocity of the origin of laparoscope_optical and its angular velocity, expressed in aesop_base.
geometry_msgs::TwistStamped opticalTwist(const aesop::Kinematics& kinematics, const aesop::Status& status,
                                         const std::string& prefix, const ros::Time& stamp);

// Transforms from aesop_base to link_1 ... link_6 to end_effector.
std::vector<geometry_msgs::TransformStamped> linkTransforms(const aesop::Kinematics& kinematics,
                                                            const aesop::JointVector& q, const std::string& prefix,
                                                            const ros::Time& stamp);
// Transforms from end_effector to scope_tip to laparoscope_optical, and from aesop_base to insertion_point (axes
// parallel to the base's).
std::vector<geometry_msgs::TransformStamped> fixedTransforms(const aesop::Kinematics& kinematics,
                                                             const Eigen::Vector3d& insertion_point,
                                                             const Eigen::Matrix3d& tip_R_optical,
                                                             const std::string& prefix, const ros::Time& stamp);

}  // namespace laparoscope_servo
