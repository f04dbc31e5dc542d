#include "laparoscope_servo/ros/aesop_node.h"

#include <ros/callback_queue.h>
#include <ros/ros.h>

#include <chrono>
#include <thread>

#include "laparoscope_servo/ros/aesop_conversions.h"
#include "laparoscope_servo/servo/scope_geometry.h"

namespace laparoscope_servo::skin {

namespace {

using aesop::OperatingMode;

constexpr std::chrono::milliseconds kPeriod{5};
constexpr double kReconnectPause = 0.5;    // s
constexpr double kReportPause = 1.0;       // s, between two warnings of one kind
constexpr double kDiagnosticsPause = 1.0;  // s
constexpr double kStatePeriod = 0.1;       // s, between two publications of an operating state that stays
constexpr double kLastWord = 0.5;          // s, for the controller to confirm the disable when the node ends

double steadyNow() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}
double stampNow() {
  return ros::Time::now().toSec();
}

}  // namespace

AesopNode::AesopNode(const ros::NodeHandle& node, const ros::NodeHandle& private_node,
                     const AesopParameters& parameters)
    : parameters_(parameters),
      tip_R_optical_(servo::obliqueOptics(parameters.optics_angle, parameters.optics_roll).transpose()),
      driver_(parameters.driver),
      calibration_(private_node, parameters, driver_),
      line_warning_(aesop::lineWarning(parameters.driver.session, parameters.baud_rate)),
      node_(node),
      private_node_(private_node) {
  joint_publisher_ = private_node_.advertise<sensor_msgs::JointState>("measured_js", 10);
  pose_publisher_ = private_node_.advertise<geometry_msgs::PoseStamped>("measured_cp", 10);
  twist_publisher_ = private_node_.advertise<geometry_msgs::TwistStamped>("measured_cv", 10);
  state_publisher_ = private_node_.advertise<OperatingState>("operating_state", 10, true);
  // Only the newest command counts.
  command_subscriber_ =
      node_.subscribe("servo_command", 1, &AesopNode::onCommand, this, ros::TransportHints().tcpNoDelay());
  services_ = {private_node_.advertiseService("enable", &AesopNode::enable, this),
               private_node_.advertiseService("disable", &AesopNode::disable, this),
               private_node_.advertiseService("clear_fault", &AesopNode::clearFault, this),
               private_node_.advertiseService("pause", &AesopNode::pause, this),
               private_node_.advertiseService("resume", &AesopNode::resume, this)};
  diagnostics_.setHardwareID(parameters_.port);
  diagnostics_.add("AESOP", this, &AesopNode::describe);
  publishStaticFrames();
  if (!line_warning_.empty()) ROS_WARN_STREAM(line_warning_);
}

void AesopNode::run(const std::atomic<bool>& stop) {
  while (!stop && ros::ok()) {
    const auto next = std::chrono::steady_clock::now() + kPeriod;
    ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(0.0));
    step();
    std::this_thread::sleep_until(next);
  }
  shutDown();
}

void AesopNode::step() {
  const double now = steadyNow();
  if (calibration_.step(stampNow(), now)) publishStaticFrames();
  if (!transport_.isOpen()) connect(now);
  if (transport_.isOpen()) {
    try {
      const aesop::Bytes received = transport_.read();
      driver_.receive(received.data(), received.size(), now);
      transport_.write(driver_.transmit(now));
    } catch (const aesop::TransportError& error) {
      lose(error.what(), now);
    }
  }
  publishStatus();
  publishState(now);
  if (now >= next_diagnostics_) {
    next_diagnostics_ = now + kDiagnosticsPause;
    diagnostics_.force_update();
  }
}

void AesopNode::connect(double now) {
  if (now < next_attempt_) return;
  next_attempt_ = now + kReconnectPause;
  try {
    transport_.open(parameters_.port, parameters_.baud_rate);
    driver_.opened(now);
    last_loss_.clear();
    ROS_INFO_STREAM("port '" << parameters_.port << "' is open");
  } catch (const aesop::TransportError& error) {
    lose(error.what(), now);
  }
}

void AesopNode::lose(const std::string& reason, double now) {
  driver_.closed(reason);
  next_attempt_ = now + kReconnectPause;
  if (reason != last_loss_) ROS_ERROR_STREAM(reason << "; the arm is taken for DISABLED, trying again");
  last_loss_ = reason;
}

bool AesopNode::stepUntil(const std::function<bool()>& done, double seconds) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  while (!done()) {
    if (std::chrono::steady_clock::now() > end) return false;
    const auto next = std::chrono::steady_clock::now() + kPeriod;
    step();
    std::this_thread::sleep_until(next);
  }
  return true;
}

void AesopNode::shutDown() {
  if (!transport_.isOpen()) return;
  driver_.disable(steadyNow());
  const auto standing = [this] {
    const auto& status = driver_.session().link().status();
    return !status || status->state != aesop::RobotState::kEnabled;
  };
  if (!stepUntil(standing, kLastWord)) {
    ROS_ERROR(
        "the controller has not confirmed the disable; it stops by itself when the last command's time has run out");
  }
  try {
    transport_.drain(0.1);
  } catch (const aesop::TransportError& error) {
    ROS_ERROR_STREAM(error.what());  // the line has gone in the meantime: nothing more can be said to it
  }
  transport_.close();
}

void AesopNode::onCommand(const ScopeVelocity& message) {
  const double now = steadyNow();
  if (calibration_.takes(fromMessage(message), now)) return;
  const std::string refusal = driver_.command(fromMessage(message), message.header.stamp.toSec(), stampNow(), now);
  // Commands that come before the arm is enabled are nobody's mistake, but one that is not finite is.
  if (refusal.empty() || now < next_report_) return;
  if (!driver_.session().isEnabled() && fromMessage(message).isFinite()) return;
  next_report_ = now + kReportPause;
  ROS_WARN_STREAM("a command was refused: " << refusal);
}

bool AesopNode::enable(Request&, Response& response) {
  response.message = driver_.enable(stampNow(), steadyNow());
  if (!response.message.empty()) return true;
  const auto settled = [this] {
    return driver_.session().isEnabled() || !driver_.session().link().isUp() || !driver_.state(steadyNow()).is_busy;
  };
  stepUntil(settled, parameters_.driver.session.request_timeout + 0.1);
  response.success = driver_.session().isEnabled();
  response.message = response.success ? "enabled" : driver_.state(steadyNow()).reason;
  return true;
}

bool AesopNode::disable(Request&, Response& response) {
  response.message = driver_.disable(steadyNow());
  if (!response.message.empty()) return true;
  const auto settled = [this] { return !driver_.state(steadyNow()).is_busy; };
  response.success = stepUntil(settled, parameters_.driver.session.request_timeout) && driver_.session().link().isUp();
  response.message =
      response.success ? "disabled, the arm stands" : "the controller has not confirmed that the arm stands";
  return true;
}

bool AesopNode::clearFault(Request&, Response& response) {
  response.message = driver_.clearFault(steadyNow());
  if (!response.message.empty()) return true;
  const auto settled = [this] { return !driver_.state(steadyNow()).is_busy; };
  stepUntil(settled, parameters_.driver.session.request_timeout + 0.1);
  const aesop::OperatingState state = driver_.state(steadyNow());
  response.success = state.mode == OperatingMode::kDisabled && driver_.session().link().isUp();
  response.message = state.reason;
  return true;
}

bool AesopNode::pause(Request&, Response& response) {
  response.message = driver_.pause();
  response.success = response.message.empty();
  return true;
}

bool AesopNode::resume(Request&, Response& response) {
  response.message = driver_.resume(stampNow());
  response.success = response.message.empty();
  return true;
}

void AesopNode::publishStatus() {
  const aesop::Link& link = driver_.session().link();
  if (!link.status() || link.statistics().received == published_) return;
  published_ = link.statistics().received;
  const ros::Time stamp = ros::Time::now();
  const aesop::Status& status = *link.status();
  const std::string& prefix = parameters_.frame_prefix;
  joint_publisher_.publish(jointState(status, stamp));
  pose_publisher_.publish(opticalPose(driver_.kinematics(), status, tip_R_optical_, prefix, stamp));
  twist_publisher_.publish(opticalTwist(driver_.kinematics(), status, prefix, stamp));
  broadcaster_.sendTransform(linkTransforms(driver_.kinematics(), status.position, prefix, stamp));
}

void AesopNode::publishState(double now) {
  const aesop::OperatingState state = driver_.state(now);
  // Repeated, so that who relies on it notices when it ends.
  if (state_published_ && state == last_state_ && now - state_time_ < kStatePeriod) return;
  state_time_ = now;
  if (!state_published_ || state.mode != last_state_.mode) {
    ROS_INFO_STREAM(aesop::name(state.mode) << (state.reason.empty() ? "" : ": ") << state.reason);
  }
  last_state_ = state;
  state_published_ = true;
  state_publisher_.publish(toMessage(state, ros::Time::now()));
}

void AesopNode::publishStaticFrames() {
  static_broadcaster_.sendTransform(
      fixedTransforms(driver_.kinematics(), driver_.insertionPoint(), tip_R_optical_, parameters_.frame_prefix, ros::Time::now()));
}

void AesopNode::describe(diagnostic_updater::DiagnosticStatusWrapper& status) {
  using diagnostic_msgs::DiagnosticStatus;
  const double now = steadyNow();
  const aesop::Link& link = driver_.session().link();
  const aesop::LinkStatistics& statistics = link.statistics();
  const aesop::OperatingState state = driver_.state(now);
  const std::uint64_t errors = statistics.decoder.crc_errors + statistics.decoder.malformed + statistics.lost;
  status.summary(DiagnosticStatus::OK,
                 std::string(aesop::name(state.mode)) + (state.reason.empty() ? "" : ": ") + state.reason);
  if (!link.isUp() || state.mode == OperatingMode::kFault) {
    status.level = DiagnosticStatus::ERROR;
  } else if (!line_warning_.empty()) {
    status.mergeSummary(DiagnosticStatus::WARN, line_warning_);
  } else if (errors > errors_reported_) {
    status.mergeSummary(DiagnosticStatus::WARN, "the line loses bytes");
  }
  errors_reported_ = errors;
  status.add("port", parameters_.port);
  status.add("link", aesop::name(link.state()));
  status.add("controller", link.model());
  status.add("state", aesop::name(state.mode));
  status.add("age of the last status [s]", link.statusAge(now));
  status.add("age of the last command [s]", driver_.guard().age(now));
  status.add("commands accepted", driver_.guard().accepted());
  status.add("commands refused", driver_.guard().refused());
  calibration_.describe(status);
  status.add("round trip [s]", statistics.round_trip);
  status.add("longest round trip [s]", statistics.longest_round_trip);
  status.add("requests sent", statistics.sent);
  status.add("statuses received", statistics.received);
  status.add("replies lost", statistics.lost);
  status.add("CRC errors", statistics.decoder.crc_errors);
  status.add("malformed frames", statistics.decoder.malformed);
  status.add("bytes skipped", statistics.decoder.skipped_bytes);
  status.add("sessions", statistics.sessions);
}

}  // namespace laparoscope_servo::skin
