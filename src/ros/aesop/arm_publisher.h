// What the aesop node publishes of the arm: joints, pose and twist of the camera, tf, and its operating state.
#pragma once

#include <ros/node_handle.h>
#include <tf2_ros/static_transform_broadcaster.h>
#include <tf2_ros/transform_broadcaster.h>

#include <Eigen/Core>
#include <cstdint>
#include <string>

#include "laparoscope_servo/aesop/driver.h"
#include "ros/aesop/aesop_parameters.h"
#include "ros/aesop/status_stamp.h"

namespace laparoscope_servo {

class ArmPublisher {
 public:
  ArmPublisher(ros::NodeHandle& private_node, const AesopParameters& parameters);

  // measured_js, measured_cp, measured_cv and tf, once for each status that the arm has sent.
  void publishStatus(const aesop::Driver& driver, double now);
  // operating_state: when it has changed, and repeatedly, so that subscribers notice when it stops. Call it in each
  // step, since it counts how often the arm was enabled.
  void publishState(const aesop::OperatingState& state, aesop::OperatingMode mode, double now);
  // The frames that do not move with the joints. Call it again when the insertion point has changed.
  void publishStaticFrames(const aesop::Driver& driver);

 private:
  std::string frame_prefix_;
  Eigen::Matrix3d tip_R_optical_;
  StatusStamp status_stamp_;
  std::uint64_t published_ = 0;  // number of statuses received at the last publication
  aesop::OperatingState last_state_;
  bool state_published_ = false;
  std::uint32_t enables_ = 0;  // see OperatingState.msg
  bool was_on_ = false;        // ENABLED or PAUSED in the last step
  double state_time_ = 0.0;    // s, steady, of the last publication

  ros::Publisher joint_publisher_;
  ros::Publisher pose_publisher_;
  ros::Publisher twist_publisher_;
  ros::Publisher state_publisher_;
  tf2_ros::TransformBroadcaster broadcaster_;
  tf2_ros::StaticTransformBroadcaster static_broadcaster_;
};

}  // namespace laparoscope_servo
