// Who presses the dead-man switch and holds the stick: repeats both at 25 Hz, in a thread of its own.
#pragma once

#include <ros/ros.h>
#include <std_msgs/Bool.h>

#include <mutex>
#include <optional>
#include <random>
#include <thread>

#include "laparoscope_servo/ScopeVelocity.h"

namespace laparoscope_servo::test {

class Operator {
 public:
  Operator() : thread_([this] { run(); }) {}
  ~Operator() {
    set([this] { ends_ = true; });
    thread_.join();
  }
  Operator(const Operator&) = delete;
  Operator& operator=(const Operator&) = delete;

  void press(bool pressed) {
    set([=] {
      pressed_ = pressed;
      bounces_ = false;
    });
  }
  // Pressed and released in turn, with each word.
  void bounceSwitch() {
    set([this] { bounces_ = true; });
  }
  // How often the switch has been told.
  int told() {
    const std::lock_guard<std::mutex> lock(mutex_);
    return told_;
  }
  // Says nothing at all about the switch.
  void dropSwitch() {
    set([this] { pressed_.reset(); });
  }
  // rad/s; with noise, standard deviation, as of a worn potentiometer.
  void push(double pan, double noise = 0.0) {
    set([=] {
      stick_ = ScopeVelocity();
      stick_->pan = pan;
      noise_ = noise;
    });
  }
  // Says nothing at all about the stick.
  void dropStick() {
    set([this] { stick_.reset(); });
  }
  // s, added to the stick's stamps.
  void shiftStamps(double seconds) {
    set([=] { shift_ = seconds; });
  }

 private:
  template <typename Change>
  void set(const Change& change) {
    const std::lock_guard<std::mutex> lock(mutex_);
    change();
  }

  void run() {
    for (ros::WallRate rate(25.0); say(); rate.sleep()) {
    }
  }

  bool say() {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (bounces_ && pressed_) pressed_ = !*pressed_;
    if (pressed_) {
      std_msgs::Bool pressed;
      pressed.data = static_cast<std::uint8_t>(*pressed_);
      switch_publisher_.publish(pressed);
      ++told_;
    }
    if (stick_) {
      ScopeVelocity word = *stick_;
      word.header.stamp = ros::Time::now() + ros::Duration(shift_);
      if (noise_ > 0.0) word.pan += std::normal_distribution<double>(0.0, noise_)(random_);
      stick_publisher_.publish(word);
    }
    return !ends_;
  }

  ros::NodeHandle node_;
  ros::Publisher switch_publisher_ = node_.advertise<std_msgs::Bool>("dead_man", 1);
  ros::Publisher stick_publisher_ = node_.advertise<ScopeVelocity>("controller/manual", 1);
  std::mutex mutex_;
  bool ends_ = false;
  int told_ = 0;
  std::optional<bool> pressed_ = false;
  bool bounces_ = false;
  std::optional<ScopeVelocity> stick_;
  double shift_ = 0.0;
  double noise_ = 0.0;
  std::mt19937 random_{3};
  std::thread thread_;
};

}  // namespace laparoscope_servo::test
