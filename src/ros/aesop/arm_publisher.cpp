#include "ros/aesop/arm_publisher.h"

#include <ros/ros.h>

#include <optional>

#include "laparoscope_servo/scope/geometry.h"
#include "ros/aesop/aesop_conversions.h"

namespace laparoscope_servo {

namespace {

constexpr double kStatePeriod = 0.05;  // s, between two publications of an unchanged operating state

}  // namespace

ArmPublisher::ArmPublisher(ros::NodeHandle& private_node, const AesopParameters& parameters)
    : frame_prefix_(parameters.frame_prefix),
      tip_R_optical_(scope::obliqueOptics(parameters.optics_angle, parameters.optics_roll).transpose()),
      joint_publisher_(private_node.advertise<sensor_msgs::JointState>("measured_js", 10)),
      pose_publisher_(private_node.advertise<geometry_msgs::PoseStamped>("measured_cp", 10)),
      twist_publisher_(private_node.advertise<geometry_msgs::TwistStamped>("measured_cv", 10)),
      state_publisher_(private_node.advertise<OperatingState>("operating_state", 10, true)) {}

void ArmPublisher::publishStatus(const aesop::Driver& driver, double now) {
  const aesop::Link& link = driver.session().link();
  if (!link.status() || link.statistics().received == published_) return;
  published_ = link.statistics().received;
  const std::optional<ros::Time> taken = status_stamp_.take(link.statusAge(now), now, ros::Time::now());
  if (!taken) return;
  const ros::Time& stamp = *taken;
  const aesop::Status& status = *link.status();
  joint_publisher_.publish(jointState(status, stamp));
  pose_publisher_.publish(opticalPose(driver.kinematics(), status, tip_R_optical_, frame_prefix_, stamp));
  twist_publisher_.publish(opticalTwist(driver.kinematics(), status, frame_prefix_, stamp));
  broadcaster_.sendTransform(linkTransforms(driver.kinematics(), status.position, frame_prefix_, stamp));
}

void ArmPublisher::publishState(const aesop::OperatingState& state, aesop::OperatingMode mode, double now) {
  // A pause does not increment the count, so that the controller can go on after it.
  const bool on = mode == aesop::OperatingMode::kEnabled || mode == aesop::OperatingMode::kPaused;
  if (on && !was_on_) ++enables_;
  was_on_ = on;
  if (state_published_ && state == last_state_ && now - state_time_ < kStatePeriod) return;
  state_time_ = now;
  last_state_ = state;
  state_published_ = true;
  OperatingState message = toMessage(state, ros::Time::now());
  message.enables = enables_;
  state_publisher_.publish(message);
}

void ArmPublisher::publishStaticFrames(const aesop::Driver& driver) {
  static_broadcaster_.sendTransform(
      fixedTransforms(driver.kinematics(), driver.insertionPoint(), tip_R_optical_, frame_prefix_, ros::Time::now()));
}

}  // namespace laparoscope_servo
