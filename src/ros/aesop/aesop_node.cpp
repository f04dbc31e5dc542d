#include "ros/aesop/aesop_node.h"

#include <ros/callback_queue.h>
#include <ros/ros.h>

#include <chrono>
#include <stdexcept>
#include <thread>

#include "ros/aesop/aesop_conversions.h"
#include "ros/common/clocks.h"
#include "ros/common/realtime.h"

namespace laparoscope_servo {

namespace {

constexpr std::chrono::milliseconds kPeriod{5};
constexpr std::uint32_t kQueue = 1000;  // commands: 0.1 s of another publisher that floods the topic at 10 kHz
constexpr double kReportPause = 1.0;    // s, between two warnings of commands that are refused for the same reason
// s, between two warnings about the same publisher that does not own the commands
constexpr double kStrangerPause = 10.0;
constexpr double kDiagnosticsPause = 1.0;  // s
constexpr double kLastWord = 0.5;          // s, for the controller to confirm the disable when the node ends

std::vector<std::string> resolved(const ros::NodeHandle& node, const std::vector<std::string>& names) {
  std::vector<std::string> result;
  for (const std::string& name : names) result.push_back(node.resolveName(name, false));
  return result;
}

}  // namespace

AesopNode::AesopNode(const ros::NodeHandle& node, const ros::NodeHandle& private_node,
                     const AesopParameters& parameters)
    : parameters_(parameters),
      driver_(parameters.driver),
      reconnect_(parameters.reconnect),
      command_owner_(node.resolveName(parameters.publisher, false), "commands", "command/publisher"),
      callers_(resolved(node, parameters.service_callers)),
      calibration_(private_node, parameters, callers_, service_errors_, driver_),
      reported_(parameters.port, aesop::lineWarning(parameters.driver.session, parameters.baud_rate)),
      refused_lines_(kReportPause),
      stranger_lines_(kStrangerPause),
      stops_(parameters.external_stops),
      node_(node),
      private_node_(private_node),
      publisher_(private_node_, parameters) {
  // Only the owner's newest command counts, but those of others must not push it out of the queue.
  command_subscriber_ =
      node_.subscribe("servo_command", kQueue, &AesopNode::onCommand, this, ros::TransportHints().tcpNoDelay());
  stop_subscriber_ = private_node_.subscribe("stop", 1, &AesopNode::onStop, this, ros::TransportHints().tcpNoDelay());
  advertise("enable", &AesopNode::enable, Callers::kNamed);
  advertise("resume", &AesopNode::resume, Callers::kNamed);
  advertise("clear_fault", &AesopNode::clearFault, Callers::kNamed);
  // Services that stop the arm may be called by every node.
  advertise("disable", &AesopNode::disable, Callers::kAll);
  advertise("pause", &AesopNode::pause, Callers::kAll);
  diagnostics_.setHardwareID(parameters_.port);
  diagnostics_.add("AESOP", [this](diagnostic_updater::DiagnosticStatusWrapper& status) {
    const double now = steadyNow();
    reported_.fill(now, driver_, {command_owner_, command_subscriber_.getNumPublishers(), reconnect_.remaining(now)},
                   status);
    stops_.describe(now, status);
    calibration_.describe(status);
    if (recording_ && !recording_->problem().empty())
      status.mergeSummary(diagnostic_msgs::DiagnosticStatus::WARN, recording_->problem());
  });
  if (!parameters.wire_log.file.empty()) {
    recording_ = std::make_unique<aesop::WireLogFile>(parameters.wire_log, parameters.driver.session.codec()->name());
    driver_.setTap(recording_.get());
  }
  publisher_.publishStaticFrames(driver_);
  if (!reported_.lineWarning().empty()) ROS_WARN_STREAM(reported_.lineWarning());
}

void AesopNode::run(const std::function<bool()>& stop) {
  if (parameters_.realtime_priority > 0) {
    const std::string refusal = goRealtime(parameters_.realtime_priority);
    if (!refusal.empty()) ROS_WARN_STREAM(refusal);
  }
  try {
    while (!stop() && ros::ok()) {
      const auto next = std::chrono::steady_clock::now() + kPeriod;
      ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(0.0));
      service_errors_.rethrow();
      step();
      if (stops_.mustEnd()) throw std::runtime_error(stops_.masterProblem());
      std::this_thread::sleep_until(next);
    }
  } catch (const std::exception& error) {
    ROS_FATAL_STREAM(error.what() << "; the arm is disabled, the node ends");
    // only the exchange with the arm, since any other part may have failed
    shutDown([this] { exchange(steadyNow()); });
    throw;
  }
  shutDown([this] { step(); });
}

void AesopNode::exchange(double now) {
  if (!transport_.isOpen()) return;
  try {
    const aesop::Bytes received = transport_.read();
    driver_.receive(received.data(), received.size(), now);
    transport_.write(driver_.transmit(now));
  } catch (const aesop::TransportError& error) {
    lose(error.what(), now);
  }
}

void AesopNode::step() {
  const double now = steadyNow();
  if (calibration_.step(stampNow(), now)) publisher_.publishStaticFrames(driver_);
  if (!transport_.isOpen()) connect(now);
  watchOutside(now);
  exchange(now);
  if (driver_.session().link().isUp()) reconnect_.up(now);
  if (!driver_.session().isEnabled()) command_owner_.release();
  watchRecording();
  publisher_.publishStatus(driver_, steadyNow());
  publisher_.publishState(state(now), driver_.session().state().mode, now);
  reportState(now);
  if (now >= next_diagnostics_) {
    next_diagnostics_ = now + kDiagnosticsPause;
    diagnostics_.force_update();
  }
}

void AesopNode::watchOutside(double now) {
  const std::string stop = stops_.takeStop(now);
  if (!stop.empty()) stopArm(stop, now);
  // At every step, since an enable that was under way may be confirmed meanwhile.
  const std::string& problem = stops_.masterProblem();
  if (!problem.empty() && driver_.session().isEnabled()) driver_.pause(problem);
  // Clears the last command; one that comes meanwhile is cleared at the next step.
  if (stops_.masterIsLate(now) && driver_.session().isEnabled()) driver_.command({}, 0.0, stampNow(), now);
}

void AesopNode::stopArm(const std::string& reason, double now) {
  // A repeated request would need another confirmation, so a flood of requests would never end.
  const aesop::OperatingState state = driver_.state(now);
  if (state.mode != aesop::OperatingMode::kDisabled || state.reason != reason) driver_.stop(now, reason);
}

void AesopNode::onStop(const ros::MessageEvent<std_msgs::Empty const>& event) {
  stopArm("stopped by " + shownName(event.getPublisherName()), steadyNow());
}

void AesopNode::watchRecording() {
  if (!recording_ || recording_ended_ || recording_->problem().empty()) return;
  recording_ended_ = true;
  ROS_WARN_STREAM(recording_->problem() << "; the arm is driven on without it");
}

void AesopNode::connect(double now) {
  if (!reconnect_.due(now)) return;
  try {
    transport_.open(parameters_.port, parameters_.baud_rate);
    driver_.opened(now);
    ROS_INFO_STREAM(
        "port '" << parameters_.port << "' is open, "
                 << (transport_.lowLatency() ? "set to low latency" : "its driver has no low-latency setting"));
  } catch (const aesop::TransportError& error) {
    lose(error.what(), now);
  }
}

void AesopNode::lose(const std::string& reason, double now) {
  driver_.closed(reason);
  reconnect_.lost(now);
}

bool AesopNode::repeatUntil(const std::function<bool()>& done, double seconds, const std::function<void()>& step) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  while (!done()) {
    if (std::chrono::steady_clock::now() > end) return false;
    const auto next = std::chrono::steady_clock::now() + kPeriod;
    step();
    std::this_thread::sleep_until(next);
  }
  return true;
}

bool AesopNode::stepUntil(const std::function<bool()>& done, double seconds) {
  return repeatUntil(done, seconds, [this] { step(); });
}

void AesopNode::shutDown(const std::function<void()>& step) {
  if (!transport_.isOpen()) return;
  driver_.disable(steadyNow());
  // Confirmed by a status that answers it and reports rest.
  const auto standing = [this] { return !driver_.session().link().isUp() || !driver_.session().state().is_busy; };
  if (!repeatUntil(standing, kLastWord, step)) {
    ROS_ERROR(
        "the controller has not confirmed the disable; it stops by itself when the last command's time has run out");
  }
  try {
    transport_.drain(0.1);
  } catch (const aesop::TransportError& error) {
    ROS_ERROR_STREAM(error.what());  // the line was lost meanwhile: nothing can be sent any more
  }
  transport_.close();
}

void AesopNode::onCommand(const ros::MessageEvent<ScopeVelocity const>& event) {
  const double now = steadyNow();
  const ScopeVelocity& message = *event.getConstMessage();
  switch (command_owner_.judge(event.getPublisherName(), event.getConnectionHeaderPtr(), now)) {
    case InputOwner::Verdict::kStranger:
      if (const auto line = stranger_lines_.take(command_owner_.complaint(now), now)) ROS_WARN_STREAM(*line);
      return;
    case InputOwner::Verdict::kNewConnection:
      // The publisher was restarted, replaced by another process of its name, or joined by one. An operator must
      // confirm, with the arm at rest, which process may command it.
      driver_.pause(command_owner_.name() + " has connected anew; resume when it may command the arm");
      return;
    case InputOwner::Verdict::kOwner:
      break;
  }
  const scope::Velocity velocity = fromMessage(message);
  if (calibration_.takes(velocity, now)) return;
  const std::string refusal = driver_.command(velocity, message.header.stamp.toSec(), stampNow(), now);
  // Commands before the arm is enabled are no error, except a non-finite one.
  if (refusal.empty() || (!driver_.session().isEnabled() && velocity.isFinite())) return;
  if (const auto line = refused_lines_.take("a command was refused: " + refusal, now)) ROS_WARN_STREAM(*line);
}

aesop::OperatingState AesopNode::state(double now) const {
  aesop::OperatingState state = driver_.state(now);
  const std::string complaint = command_owner_.complaint(now);
  if (state.mode == aesop::OperatingMode::kEnabled && stops_.masterIsLate(now))
    state.reason = "held until the ROS master answers";
  if (!complaint.empty()) state.reason += (state.reason.empty() ? "" : "; ") + complaint;
  return state;
}

void AesopNode::reportState(double now) {
  aesop::OperatingState state = driver_.state(now);
  // Logged by onCommand(), which misses none of them.
  if (state.mode == aesop::OperatingMode::kEnabled && state.reason.rfind("command refused: ", 0) == 0)
    state.reason.clear();
  const std::optional<StateLine> line = state_report_.take(state, driver_.session(), now);
  if (!line) return;
  if (line->severity == Severity::kError) {
    ROS_ERROR_STREAM(line->text);
  } else if (line->severity == Severity::kWarning) {
    ROS_WARN_STREAM(line->text);
  } else {
    ROS_INFO_STREAM(line->text);
  }
}

}  // namespace laparoscope_servo
