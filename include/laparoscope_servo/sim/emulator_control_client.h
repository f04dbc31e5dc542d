// Client of the emulator's control socket, for the simulated camera, the demo director and tests. Blocks, for a bounded
// time.
#pragma once

#include <memory>
#include <string>

#include "laparoscope_servo/aesop/messages.h"
#include "laparoscope_servo/aesop/scope_motion.h"

namespace laparoscope_servo::sim {

struct EmulatorState {
  double time = 0.0;  // s since the emulator was switched on
  aesop::JointVector q = aesop::JointVector::Zero();
};

struct EmulatorMotion {
  std::string state;  // DISABLED, ENABLED or FAULT
  bool moving = false;
  int faults = 0;
  aesop::JointVector qdot = aesop::JointVector::Zero();
};

struct EmulatorRecord {
  double velocity_age = -1.0;   // s since the controller took a velocity other than zero; -1: never
  double motion_age = -1.0;     // s since a motor moved a joint; -1: never
  double longest_motion = 0.0;  // s, longest motion of the motors after the last velocity taken, so far
};

class EmulatorControlClient {
 public:
  // Throws std::runtime_error if nothing listens at `path`. `timeout`: s, for each request.
  explicit EmulatorControlClient(const std::string& path, double timeout = 1.0);
  ~EmulatorControlClient();
  EmulatorControlClient(const EmulatorControlClient&) = delete;
  EmulatorControlClient& operator=(const EmulatorControlClient&) = delete;

  // Sends a line, and returns the text after "ok " in the answer. Throws std::runtime_error for an answer "error ...",
  // without an answer in time, and if the emulator is gone; after the last two the client cannot be used any more.
  std::string request(const std::string& line);

  EmulatorState state();
  EmulatorMotion motion();
  EmulatorRecord record();
  // Moves the scope by hand: displacements in rad and m, evenly within `seconds`.
  void hand(const scope::Velocity& displacement, double seconds);
  void fault(const std::string& name) { request("fault " + name); }
  void fault(const std::string& name, double value);

 private:
  class Connection;
  std::unique_ptr<Connection> connection_;
};

}  // namespace laparoscope_servo::sim
