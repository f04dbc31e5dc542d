// The arm, as a node uses it: scope velocities in, joint states and the robot's state out, bytes to and from the line.
//
// Pure: no port, no clock, no thread. `now` is seconds of a steady clock; for stamps see CommandGuard. Call receive()
// with the bytes received and then transmit(), always and at a steady rate above that of the link.
#pragma once

#include "laparoscope_servo/aesop/command_guard.h"
#include "laparoscope_servo/aesop/motion_delay.h"
#include "laparoscope_servo/aesop/motion_monitor.h"
#include "laparoscope_servo/aesop/session.h"
#include "laparoscope_servo/aesop/wire_log.h"

namespace laparoscope_servo::aesop {

struct DriverConfig {
  KinematicsConfig kinematics;
  MotionConfig motion;
  CommandConfig command;
  SessionConfig session;
  MonitorConfig monitor;
  Eigen::Vector3d insertion_point{0.574, -0.079, -0.05};  // m, in aesop_base
};

// All errors of all parts, each with the name of its group in front.
std::vector<std::string> validate(const DriverConfig& config);

class Driver {
 public:
  // Throws std::invalid_argument that lists the errors of the configuration.
  explicit Driver(const DriverConfig& config);

  // As in Session. Enable also refuses all commands that were stamped before it.
  std::string enable(double stamp_now, double now);
  std::string disable(double now);
  std::string stop(double now, const std::string& reason);
  std::string clearFault(double now);
  std::string pause(const std::string& reason = "paused on request");
  std::string resume(double stamp_now);

  // Accepts a command, or returns why not. Commands while not ENABLED are checked, but have no effect, then or later.
  std::string command(const scope::Velocity& velocity, double stamp, double stamp_now, double now);

  // Sets another insertion point [m, in aesop_base], or returns why not: never while ENABLED, PAUSED or in FAULT, nor
  // while the arm moves.
  std::string setInsertionPoint(const Eigen::Vector3d& point);

  void opened(double now);
  void closed(const std::string& reason);
  void receive(const std::uint8_t* data, std::size_t size, double now);
  Bytes transmit(double now);

  // Passes all further input and output of the driver to `tap` also, which must outlive the driver; null: none.
  void setTap(WireTap* tap) { tap_ = tap; }
  // As in Link.
  void setSequence(std::uint16_t sequence) { session_.setSequence(sequence); }

  // The session's state. While ENABLED its reason is why the arm does not execute the command; empty if it does.
  OperatingState state(double now) const;
  const Session& session() const { return session_; }
  const CommandGuard& guard() const { return guard_; }
  const Kinematics& kinematics() const { return kinematics_; }
  const Eigen::Vector3d& insertionPoint() const { return insertion_point_; }
  // The arm's own delay, measured from the messages sent and received.
  const MotionDelay& delay() const { return delay_; }
  // The joint motion that the last call of transmit() computed for the command.
  const JointMotion& lastMotion() const { return last_motion_; }

 private:
  void watchMotion(double now);
  Bytes cycle(double now);
  void record(WireEvent event, Bytes payload = {});
  void record(WireEvent event, double now, Bytes payload = {});

  Kinematics kinematics_;
  MotionConfig motion_;
  Eigen::Vector3d insertion_point_;
  CommandGuard guard_;
  Session session_;
  MotionDelay delay_;
  std::uint64_t statuses_ = 0;       // number of statuses received when the last one was evaluated
  std::uint64_t link_sessions_ = 0;  // number of sessions of the link at that time
  MotionMonitor monitor_;
  std::array<double, kDrivenJoints> speed_{};  // last commanded velocities of the driven joints
  JointMotion last_motion_;
  std::string refusal_;  // why the last command was refused; empty if it was accepted
  WireTap* tap_ = nullptr;
  std::int64_t tap_time_ = 0;  // ns, of the last record
  Bytes tap_state_;            // the last recorded state
};

}  // namespace laparoscope_servo::aesop
