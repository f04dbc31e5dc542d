// The arm, as a node uses it: scope velocities in, joint states and the robot's state out, bytes to and from the line.
//
// Pure: no port, no clock, no thread. `now` is seconds of a steady clock; for stamps see CommandGuard. Call receive()
// with what has come and then transmit() at a steady rate above that of the link, whatever else happens.
#pragma once

#include "laparoscope_servo/aesop/command_guard.h"
#include "laparoscope_servo/aesop/session.h"

namespace laparoscope_servo::aesop {

struct DriverConfig {
  KinematicsConfig kinematics;
  MotionConfig motion;
  CommandConfig command;
  SessionConfig session;
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
  std::string disable(double now) { return session_.disable(now); }
  std::string clearFault(double now) { return session_.clearFault(now); }
  std::string pause() { return session_.pause(); }
  std::string resume(double stamp_now);

  // Takes a command, or says why not. Commands while not ENABLED are judged, but move nothing.
  std::string command(const ScopeVelocity& velocity, double stamp, double stamp_now, double now);

  // Another insertion point [m, in aesop_base], or why not: never while ENABLED, PAUSED or in FAULT, nor while the arm
  // moves.
  std::string setInsertionPoint(const Eigen::Vector3d& point);

  void opened(double now) { session_.opened(now); }
  void closed(const std::string& reason) { session_.closed(reason); }
  void receive(const std::uint8_t* data, std::size_t size, double now) { session_.receive(data, size, now); }
  Bytes transmit(double now);

  // Session's state; while ENABLED its reason says why the arm does not do what was commanded, and is empty when it
  // does.
  OperatingState state(double now) const;
  const Session& session() const { return session_; }
  const CommandGuard& guard() const { return guard_; }
  const Kinematics& kinematics() const { return kinematics_; }
  const Eigen::Vector3d& insertionPoint() const { return insertion_point_; }
  // What the last call of transmit() made of the command.
  const JointMotion& lastMotion() const { return last_motion_; }

 private:
  Kinematics kinematics_;
  MotionConfig motion_;
  Eigen::Vector3d insertion_point_;
  CommandGuard guard_;
  Session session_;
  JointMotion last_motion_;
  std::string refusal_;  // of the last command; empty when it was accepted
};

}  // namespace laparoscope_servo::aesop
