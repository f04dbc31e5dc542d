// Stands in for tracker, robot and dead-man switch: publishes task errors (25 Hz), tf and the switch (50 Hz) and the
// robot's state (17 Hz) from a thread of its own, and listens to what the controller says.
#pragma once

#include <gtest/gtest.h>
#include <laparoscope_servo/ControllerState.h>
#include <laparoscope_servo/OperatingState.h>
#include <laparoscope_servo/ScopeVelocity.h>
#include <ros/ros.h>
#include <std_msgs/Bool.h>
#include <std_srvs/SetBool.h>
#include <tf2_ros/transform_broadcaster.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "feed.h"
#include "ros/common/clocks.h"

namespace laparoscope_servo {

inline bool isZero(const ScopeVelocity& c) {
  return c.pan == 0.0 && c.tilt == 0.0 && c.spin == 0.0 && c.insertion == 0.0;
}

// Waits until `condition` holds, at most `seconds`; polls, since what is waited for happens in other processes.
inline bool waitFor(const std::function<bool()>& condition, double seconds = 20.0) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  while (std::chrono::steady_clock::now() < end) {
    if (condition()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return condition();
}

class FakeCart {
 public:
  // `controller`: its node name, `command`: the topic on which it commands.
  explicit FakeCart(const std::string& controller = "/controller", const std::string& command = "/servo_command")
      : spinner_(2) {
    feed_.message = offTarget();
    task_error_publisher_ = node_.advertise<TaskError>("/task_error", 1);
    robot_publisher_ = node_.advertise<OperatingState>("/operating_state", 1);
    dead_man_publisher_ = node_.advertise<std_msgs::Bool>("/dead_man", 1);
    command_subscriber_ = node_.subscribe<ScopeVelocity>(
        command, 100, [this](const ScopeVelocity::ConstPtr& message) { onCommand(*message); }, ros::VoidConstPtr(),
        ros::TransportHints().tcpNoDelay());
    state_subscriber_ =
        node_.subscribe<ControllerState>(controller + "/state", 100, [this](const ControllerState::ConstPtr& message) {
          const std::lock_guard<std::mutex> lock(mutex_);
          state_ = *message;
          states_.push_back(message->state);
        });
    engage_ = node_.serviceClient<std_srvs::SetBool>(controller + "/engage");
    spinner_.start();
    publisher_ = std::thread([this] { publishUntilEnd(); });
  }

  ~FakeCart() { end(); }

  // Publishes and hears nothing any more.
  void end() {
    end_ = true;
    if (publisher_.joinable()) publisher_.join();
    spinner_.stop();
  }

  void set(const std::function<void(Feed&)>& change) {
    const std::lock_guard<std::mutex> lock(mutex_);
    change(feed_);
  }

  // Changes what is published and sends it at once; the time of that, s on the steady clock.
  double strike(const std::function<void(Feed&)>& change) {
    const std::lock_guard<std::mutex> one_at_a_time(publish_mutex_);
    set(change);
    const double time = steadyNow();
    publish(0);
    return time;
  }

  // Sends everything once with this change, and goes on without it.
  void once(const std::function<void(Feed&)>& change) {
    const std::lock_guard<std::mutex> one_at_a_time(publish_mutex_);
    Feed before;
    set([&](Feed& feed) { before = feed, change(feed); });
    publish(0);
    set([&](Feed& feed) { feed = before; });
  }

  // Sends everything once more as it was, then changes it: for what falls silent. The time of the last words.
  double fallSilent(const std::function<void(Feed&)>& change) {
    const std::lock_guard<std::mutex> one_at_a_time(publish_mutex_);
    const double time = steadyNow();
    publish(0);
    set(change);
    return time;
  }

  // When the first command of zero came after the last one that was not, s on the steady clock.
  double stoodAt() {
    const std::lock_guard<std::mutex> lock(mutex_);
    return stood_at_;
  }

  ControllerState state() {
    const std::lock_guard<std::mutex> lock(mutex_);
    return state_;
  }

  std::vector<std::string> states() {
    const std::lock_guard<std::mutex> lock(mutex_);
    return states_;
  }

  // All commands since the last call.
  std::vector<ScopeVelocity> takeCommands() {
    const std::lock_guard<std::mutex> lock(mutex_);
    std::vector<ScopeVelocity> taken;
    taken.swap(commands_);
    return taken;
  }

  // The next `count` commands.
  std::vector<ScopeVelocity> nextCommands(std::size_t count) {
    takeCommands();
    waitFor([&] {
      const std::lock_guard<std::mutex> lock(mutex_);
      return commands_.size() >= count;
    });
    return takeCommands();
  }

  bool stands() {
    const std::vector<ScopeVelocity> commands = nextCommands(5);
    for (const ScopeVelocity& command : commands) {
      if (!isZero(command)) return false;
    }
    return commands.size() >= 5;
  }

  bool moves() {
    const std::vector<ScopeVelocity> commands = nextCommands(2);
    return !commands.empty() && !isZero(commands.back());
  }

  bool waitForState(const std::string& name, double seconds = 20.0) {
    return waitFor([&] { return state().state == name; }, seconds);
  }

  bool waitForController(double seconds = 10.0) {
    return waitFor([this] { return engage_.exists() && !state().state.empty(); }, seconds);
  }

  // The answer's message; `success` tells the rest.
  std::string engage(bool on, bool& success) {
    std_srvs::SetBool call;
    call.request.data = on;
    success = engage_.call(call) && call.response.success;
    return answer_ = call.response.message;
  }

  // The last one of engage().
  const std::string& answer() const { return answer_; }

  // Engages as soon as the controller has all it needs, and lets go of a dead-man switch that is held, once.
  bool engageWhenReady(double seconds = 20.0) {
    const auto engaged = [this] {
      bool success = false;
      engage(true, success);
      return success;
    };
    if (!waitFor(engaged, seconds)) return false;
    const auto known = [this] {
      return state().state == ControllerState::ARMED || state().state == ControllerState::SERVO;
    };
    if (waitFor(known, 1.0) && state().state == ControllerState::ARMED && pressed()) letGoOnce();
    return true;
  }

  void letGoOnce() {
    strike([](Feed& feed) { feed.pressed = false; });
    waitFor([this] { return state().reason.find("is not pressed") != std::string::npos; });
    strike([](Feed& feed) { feed.pressed = true; });
  }

 private:
  bool pressed() {
    const std::lock_guard<std::mutex> lock(mutex_);
    return feed_.pressed;
  }

  void onCommand(const ScopeVelocity& command) {
    const std::lock_guard<std::mutex> lock(mutex_);
    const bool stands = isZero(command);
    if (stands && !stood_) stood_at_ = steadyNow();
    stood_ = stands;
    commands_.push_back(command);
  }

  void publishUntilEnd() {
    for (int k = 0; !end_; ++k) {
      {
        const std::lock_guard<std::mutex> one_at_a_time(publish_mutex_);
        publish(k);
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
  }

  // What is due in step k; in step 0, everything.
  void publish(int k) {
    Feed feed;
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      feed = feed_;
    }
    const ros::Time now = ros::Time::now();
    if (feed.dead_man) {
      std_msgs::Bool switch_message;
      switch_message.data = feed.pressed;
      dead_man_publisher_.publish(switch_message);
    }
    if (feed.robot && k % 3 == 0) {
      OperatingState robot;
      robot.header.stamp = now;
      robot.header.stamp += ros::Duration(feed.robot_stamp_offset);
      robot.state = feed.robot_state;
      robot.enables = feed.enables;
      robot_publisher_.publish(robot);
    }
    if (feed.tf) publishTransforms(feed, now);
    if (feed.task_error && k % 2 == 0) {
      last_image_ = feed.images_stop ? last_image_ + ros::Duration(0.001) : now + ros::Duration(feed.stamp_offset);
      feed.message.header.stamp = feed.fixed_stamp.isZero() ? last_image_ : feed.fixed_stamp;
      if (feed.without_stamp) feed.message.header.stamp = ros::Time();
      feed.message.x += 1e-9 * ++images_;  // no two pictures are the same
      task_error_publisher_.publish(feed.message);
    }
  }

  // The camera at the base's origin, the insertion point behind it.
  void publishTransforms(const Feed& feed, const ros::Time& now) {
    geometry_msgs::TransformStamped camera;
    camera.header.stamp = now + ros::Duration(feed.tf_stamp_offset);
    camera.header.frame_id = "aesop_base";
    camera.child_frame_id = "laparoscope_optical";
    camera.transform.rotation.w = 1.0;
    geometry_msgs::TransformStamped insertion_point = camera;
    insertion_point.child_frame_id = "insertion_point";
    insertion_point.transform.translation.x = feed.lateral;
    insertion_point.transform.translation.y = feed.d2 * std::sin(feed.optics);
    insertion_point.transform.translation.z = -feed.d2 * std::cos(feed.optics);
    // As on the cart, its z axis points out of the body.
    insertion_point.transform.rotation.x = 1.0;
    insertion_point.transform.rotation.w = 0.0;
    geometry_msgs::TransformStamped shaft = camera;
    shaft.header.frame_id = "laparoscope_optical";
    shaft.child_frame_id = "scope_tip";
    shaft.transform.rotation.x = std::sin(0.5 * feed.optics);
    shaft.transform.rotation.w = std::cos(0.5 * feed.optics);
    broadcaster_.sendTransform({camera, insertion_point, shaft});
  }

  ros::NodeHandle node_;
  ros::AsyncSpinner spinner_;
  tf2_ros::TransformBroadcaster broadcaster_;
  ros::Publisher task_error_publisher_;
  ros::Publisher robot_publisher_;
  ros::Publisher dead_man_publisher_;
  ros::Subscriber command_subscriber_;
  ros::Subscriber state_subscriber_;
  ros::ServiceClient engage_;
  std::string answer_;

  std::mutex publish_mutex_;  // locked before mutex_
  ros::Time last_image_;
  int images_ = 0;
  std::mutex mutex_;
  Feed feed_;
  bool stood_ = true;
  double stood_at_ = 0.0;  // s
  ControllerState state_;
  std::vector<std::string> states_;
  std::vector<ScopeVelocity> commands_;
  std::atomic<bool> end_{false};
  std::thread publisher_;
};

}  // namespace laparoscope_servo
