// A thread for services that wait: for an image, or for work of seconds.
#pragma once

#include <ros/callback_queue.h>
#include <ros/ros.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace laparoscope_servo::nodelets {

class ServiceThread {
 public:
  // The services are in this node's namespace.
  explicit ServiceThread(const ros::NodeHandle& node) : node_(node) { node_.setCallbackQueue(&queue_); }
  // Waits for a service that is being answered: what that waits for has to end before.
  ~ServiceThread() {
    if (spinner_) spinner_->stop();
    for (ros::ServiceServer& server : servers_) server.shutdown();
  }

  // Before start(); the arguments are those of ros::NodeHandle.
  template <class... Arguments>
  void advertiseService(const std::string& name, Arguments&&... arguments) {
    servers_.push_back(node_.advertiseService(name, std::forward<Arguments>(arguments)...));
  }
  void start() {
    spinner_ = std::make_unique<ros::AsyncSpinner>(1, &queue_);
    spinner_->start();
  }

 private:
  ros::CallbackQueue queue_;
  ros::NodeHandle node_;
  std::unique_ptr<ros::AsyncSpinner> spinner_;
  std::vector<ros::ServiceServer> servers_;
};

}  // namespace laparoscope_servo::nodelets
