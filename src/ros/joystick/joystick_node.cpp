#include "ros/joystick/joystick_node.h"

#include <laparoscope_servo/ScopeVelocity.h>
#include <std_msgs/Bool.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <thread>

#include "ros/common/clocks.h"

namespace laparoscope_servo {

namespace {

constexpr double kLookAgain = 1.0;  // s

}  // namespace

void describe(parameters::Table& table, JoystickNodeConfig& c) {
  table.text("device", c.device, "file of the Linux joystick API");
  table.number("rate", c.rate, {10, 100}, "Hz", "of what is published");
  describe(table, c.stick);
}

std::vector<std::string> validate(const JoystickNodeConfig& config) {
  std::vector<std::string> errors = parameters::errorsOf(config);
  if (!errors.empty()) return errors;
  return validate(config.stick);
}

JoystickNode::JoystickNode(ros::NodeHandle node, ros::NodeHandle private_node, const JoystickNodeConfig& config)
    : config_(config),
      stick_(config.stick),
      dead_man_publisher_(node.advertise<std_msgs::Bool>("dead_man", 10)),
      manual_publisher_(node.advertise<ScopeVelocity>("controller/manual", 10)),
      diagnostics_(node, private_node, ros::this_node::getName()) {
  diagnostics_.setHardwareID(config.device);
  diagnostics_.add("joystick", this, &JoystickNode::diagnose);
  // Uses the wall clock, which does not depend on simulated time.
  diagnostics_timer_ =
      node.createWallTimer(ros::WallDuration(1.0), [this](const ros::WallTimerEvent&) { diagnostics_.force_update(); });
}

void JoystickNode::run() {
  const double period = 1.0 / config_.rate;
  double next = steadyNow();
  while (ros::ok()) {
    double now = steadyNow();
    if (!device_ && now >= next_open_) open(now);
    if (device_) {
      device_->wait(next - now);
    } else {
      std::this_thread::sleep_for(std::chrono::duration<double>(std::max(next - now, 0.0)));
    }
    now = steadyNow();
    const bool urgent = device_ && read(now);
    if (urgent || now >= next) say(now);
    if (now >= next) next = now + period;
    ros::spinOnce();
  }
}

void JoystickNode::open(double now) {
  next_open_ = now + kLookAgain;
  try {
    device_ = std::make_unique<JoystickDevice>(config_.device);
    events_.clear();
  } catch (const std::exception& error) {
    close(error.what());
  }
}

bool JoystickNode::read(double now) {
  bool let_go = false;
  try {
    const std::vector<std::uint8_t> bytes = device_->read();
    events_.add(bytes.data(), bytes.size());
    while (const auto event = events_.next()) {
      ++count_;
      let_go |= stick_.event(*event, now);
    }
  } catch (const std::exception& error) {
    close(error.what());
    return true;
  }
  return let_go;
}

void JoystickNode::close(const std::string& why) {
  device_.reset();
  why_closed_ = why;
  stick_.gone();
}

void JoystickNode::say(double now) {
  const Stick::Words words = stick_.cycle(now);
  for (const bool pressed : words.dead_man) {
    std_msgs::Bool message;
    message.data = static_cast<std::uint8_t>(pressed);
    dead_man_publisher_.publish(message);
  }
  if (words.manual) {
    ScopeVelocity message;
    message.header.stamp = ros::Time::now();
    message.pan = words.manual->pan;
    message.tilt = words.manual->tilt;
    message.spin = words.manual->spin;
    message.insertion = words.manual->insertion;
    manual_publisher_.publish(message);
  }
  tellProblem();
}

// Logs each change once.
void JoystickNode::tellProblem() {
  const std::string problem = device_ ? stick_.problem() : why_closed_;
  if (problem == told_) return;
  told_ = problem;
  if (problem.empty()) {
    ROS_INFO_STREAM("the joystick '" << device_->name() << "' is ready: everything was seen released");
  } else {
    ROS_WARN_STREAM("the joystick is silent: " << problem);
  }
}

void JoystickNode::diagnose(diagnostic_updater::DiagnosticStatusWrapper& status) {
  using diagnostic_msgs::DiagnosticStatus;
  if (!device_) {
    status.summary(DiagnosticStatus::ERROR, why_closed_);
  } else if (!stick_.problem().empty()) {
    status.summary(DiagnosticStatus::WARN, stick_.problem());
  } else {
    status.summary(DiagnosticStatus::OK, stick_.isHeld() ? "held" : "ready, nothing is held");
  }
  status.add("device", device_ ? device_->name() : config_.device);
  status.add("events", count_);
}

}  // namespace laparoscope_servo
