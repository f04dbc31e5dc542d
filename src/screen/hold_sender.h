// Publishes the state of the dead-man switch and the sliders 20 times a second, in a separate thread, so that nothing
// can delay the message of a release.
#pragma once

#include <ros/node_handle.h>
#include <ros/publisher.h>

#include <array>
#include <condition_variable>
#include <mutex>
#include <thread>

#include "screen/facts.h"
#include "screen/held_control.h"

namespace laparoscope_servo::screen {

class HoldSender {
 public:
  HoldSender(ros::NodeHandle& node, HeldControl& dead_man, HeldControl& slider);
  ~HoldSender();
  HoldSender(const HoldSender&) = delete;
  HoldSender& operator=(const HoldSender&) = delete;

  // -1 to 1 of the limits; used while the slider is held.
  void setShares(const std::array<double, 4>& shares);
  void setLimits(const Limits& limits);
  // Call when a control was pressed or released: publishes at once.
  void wake();
  bool isDeadManWanted() const { return dead_man_publisher_.getNumSubscribers() > 0; }

 private:
  void run();

  HeldControl& dead_man_;
  HeldControl& slider_;
  ros::Publisher dead_man_publisher_;
  ros::Publisher manual_publisher_;

  std::mutex mutex_;
  std::condition_variable changed_;
  bool woken_ = false;
  bool ends_ = false;
  std::array<double, 4> shares_{};
  Limits limits_{};  // zero until they are known, so that nothing moves

  std::thread thread_;
};

}  // namespace laparoscope_servo::screen
