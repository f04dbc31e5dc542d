#include "screen/hold_sender.h"

#include <laparoscope_servo/ScopeVelocity.h>
#include <ros/time.h>
#include <std_msgs/Bool.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "ros/common/clocks.h"
#include "ros/common/hold_words.h"

namespace laparoscope_servo::screen {

namespace {

constexpr std::chrono::milliseconds kPeriod{50};

}  // namespace

HoldSender::HoldSender(ros::NodeHandle& node, HeldControl& dead_man, HeldControl& slider)
    : dead_man_(dead_man),
      slider_(slider),
      dead_man_publisher_(node.advertise<std_msgs::Bool>("dead_man", 10)),
      manual_publisher_(node.advertise<ScopeVelocity>("controller/manual", 10)),
      thread_([this] { run(); }) {}

HoldSender::~HoldSender() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    ends_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void HoldSender::setShares(const std::array<double, 4>& shares) {
  const std::lock_guard<std::mutex> lock(mutex_);
  shares_ = shares;
}

void HoldSender::setLimits(const Limits& limits) {
  const std::lock_guard<std::mutex> lock(mutex_);
  limits_ = limits;
}

void HoldSender::wake() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    woken_ = true;
  }
  changed_.notify_all();
}

void HoldSender::run() {
  DeadManWords dead_man;
  SliderWords sliders;
  std::unique_lock<std::mutex> lock(mutex_);
  while (!ends_) {
    changed_.wait_for(lock, kPeriod, [this] { return woken_ || ends_; });
    woken_ = false;
    const std::array<double, 4> shares = shares_;
    const Limits limits = limits_;
    const bool ends = ends_;
    lock.unlock();
    const double now = steadyNow();
    for (const bool pressed : dead_man.turn(!ends && dead_man_.isHeld(now))) {
      std_msgs::Bool message;
      message.data = static_cast<std::uint8_t>(pressed);
      dead_man_publisher_.publish(message);
    }
    const SliderWords::Word word = sliders.turn(!ends && slider_.isHeld(now), now);
    if (word != SliderWords::Word::kNothing) {
      std::array<double, 4> velocity{};
      for (std::size_t k = 0; k < velocity.size() && word == SliderWords::Word::kValue; ++k) {
        velocity[k] = std::isfinite(shares[k]) ? std::clamp(shares[k], -1.0, 1.0) * limits[k] : 0.0;
      }
      ScopeVelocity message;
      message.header.stamp = ros::Time::now();
      message.pan = velocity[0];
      message.tilt = velocity[1];
      message.spin = velocity[2];
      message.insertion = velocity[3];
      manual_publisher_.publish(message);
    }
    lock.lock();
  }
}

}  // namespace laparoscope_servo::screen
