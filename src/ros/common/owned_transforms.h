// Listens to /tf and /tf_static in place of tf2_ros::TransformListener, and keeps the transforms that TransformGate
// accepts. A separate thread receives the messages, so that a flood of them does not delay the caller.
#pragma once

#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <tf2_msgs/TFMessage.h>

#include <memory>
#include <mutex>
#include <string>

#include "ros/common/transform_gate.h"

namespace laparoscope_servo {

class OwnedTransforms {
 public:
  // The present problems of tf, see TransformGate.
  struct Word {
    std::string problem;
    std::string complaint;
    std::string changed_frame;
    std::uint64_t strange = 0;
    std::uint64_t refused = 0;
  };

  explicit OwnedTransforms(const TransformGateConfig& config);

  // Call in every step; `engaged`: the transforms are in use for motion.
  Word step(bool engaged, double steady_now);
  void clear();
  void use(const std::string& frame);
  std::shared_ptr<const tf2::BufferCore> buffer() const;

 private:
  void onTransforms(const ros::MessageEvent<tf2_msgs::TFMessage const>& event, bool is_static);

  mutable std::mutex mutex_;
  TransformGate gate_;
  ros::Time last_now_;
  ros::CallbackQueue queue_;
  ros::NodeHandle node_;
  ros::Subscriber moving_subscriber_;
  ros::Subscriber static_subscriber_;
  ros::AsyncSpinner spinner_;  // last, so that it stops before the members that its thread uses are destroyed
};

}  // namespace laparoscope_servo
