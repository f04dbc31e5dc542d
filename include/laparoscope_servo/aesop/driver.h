// The arm, as a node uses it: scope velocities in, joint states and the robot's state out, bytes to and from the line.
//
// Pure: no port, no clock, no thread. `now` is seconds of a steady clock; for stamps see CommandGuard. Call receive()
// with what has come and then transmit() at a steady rate above that of the link, whatever else happens.
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

// Every error of every part, the name of its group in front.
std::vector<std::string> validate(const DriverConfig& config);

class Driver {
 public:
  // Throws std::invalid_argument that lists the errors of the configuration.
  explicit Driver(const DriverConfig& config);

  // As in Session. The enable forgets all commands that were stamped before it.
  std::string enable(double stamp_now, double now);
  std::string disable(double now);
  std::string stop(double now, const std::string& reason);
  std::string clearFault(double now);
  std::string pause(const std::string& reason = "paused on request");
  std::string resume(double stamp_now);

  // Takes a command, or says why not. Commands while not ENABLED are judged, but move nothing, then or later.
  std::string command(const scope::Velocity& velocity, double stamp, double stamp_now, double now);

  // Another insertion point [m, in aesop_base], or why not: never while ENABLED, PAUSED or in FAULT, nor while the arm
  // moves.
  std::string setInsertionPoint(const Eigen::Vector3d& point);

  void opened(double now);
  void closed(const std::string& reason);
  void receive(const std::uint8_t* data, std::size_t size, double now);
  Bytes transmit(double now);

  // All that goes into the driver and comes out of it from now on is also given to `tap`, which has to live longer;
  // null: to nobody.
  void setTap(WireTap* tap) { tap_ = tap; }
  // As in Link.
  void setSequence(std::uint16_t sequence) { session_.setSequence(sequence); }

  // Session's state; while ENABLED its reason says why the arm does not do what was commanded, and is empty when it
  // does.
  OperatingState state(double now) const;
  const Session& session() const { return session_; }
  const CommandGuard& guard() const { return guard_; }
  const Kinematics& kinematics() const { return kinematics_; }
  const Eigen::Vector3d& insertionPoint() const { return insertion_point_; }
  // The arm's own delay, as measured by what has been sent and received.
  const MotionDelay& delay() const { return delay_; }
  // What the last call of transmit() made of the command.
  const JointMotion& lastMotion() const { return last_motion_; }

 private:
  void watchMotion(double now);
  Bytes turn(double now);
  void record(WireEvent event, Bytes payload = {});
  void record(WireEvent event, double now, Bytes payload = {});

  Kinematics kinematics_;
  MotionConfig motion_;
  Eigen::Vector3d insertion_point_;
  CommandGuard guard_;
  Session session_;
  MotionDelay delay_;
  std::uint64_t statuses_ = 0;       // received when the last one was looked at
  std::uint64_t link_sessions_ = 0;  // the same of the link's
  MotionMonitor monitor_;
  std::array<double, kDrivenJoints> speed_{};  // of the driven joints, as commanded last
  JointMotion last_motion_;
  std::string refusal_;  // of the last command; empty when it was accepted
  WireTap* tap_ = nullptr;
  std::int64_t tap_time_ = 0;  // ns, of the last record
  Bytes tap_state_;            // the last one recorded
};

}  // namespace laparoscope_servo::aesop
