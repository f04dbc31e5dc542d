// The far end of the line: an AESOP's controller as in doc/aesop_protocol.md, with an emulated arm.
//
// Pure: bytes in, bytes out; `now` is seconds from any start.
#pragma once

#include <cstdint>
#include <string>

#include "laparoscope_servo/aesop/codec.h"
#include "laparoscope_servo/sim/arm.h"
#include "laparoscope_servo/sim/lies.h"

namespace laparoscope_servo::parameters {
class Table;
}

namespace laparoscope_servo::sim {

struct EmulatorConfig {
  aesop::KinematicsConfig kinematics;
  ArmConfig arm;
  aesop::CodecFactory codec = aesop::makeOwnCodec;  // the wire format
};

// Adds the rows of all parameters, with range and meaning.
void describe(parameters::Table& table, EmulatorConfig& config);
// Without the group `kinematics`, which is the arm's.
void describeEmulator(parameters::Table& table, EmulatorConfig& config);

std::vector<std::string> validate(const EmulatorConfig& config);

// s without a good frame from the host, in ENABLED, after which the controller disables itself. It also prevents motion
// by frames that a line has held back for longer.
constexpr double kHostTimeout = 0.5;

class Emulator {
 public:
  // Throws std::invalid_argument, as Arm does. `now`: power-on.
  Emulator(const EmulatorConfig& config, double now);

  // Takes bytes from the line, and returns the bytes to send.
  aesop::Bytes receive(const std::uint8_t* data, std::size_t size, double now);
  // Simulates the time until `now`; a velocity expires in time, also within a long step.
  void step(double now);

  // Sets the cause of a fault, which lasts until a call with 0. The fault itself stays until the host clears it.
  void setFaultCause(std::uint16_t bits, double now);
  // Makes a joint ignore its commands, without a fault: index 0 to 6; -1 for none.
  void jam(int joint, double now);
  // See Arm::reverse.
  void reverse(int joint, double now);
  // See Arm::setGain and Arm::setLag.
  void setGain(double gain, double now);
  void setLag(double lag, double now);
  // Makes the statuses lie from now on.
  void lie(Lie lie, double now);
  // Like switching off and on; the arm keeps its position.
  void reboot(double now);
  // Moves the scope by hand: see Arm::hand. Refused unless DISABLED.
  std::string hand(const scope::Velocity& displacement, double seconds, double now);

  const Arm& arm() const { return arm_; }
  aesop::RobotState state() const { return state_; }
  std::uint16_t faults() const { return faults_; }
  // s since the last velocity other than zero was taken; infinite before the first.
  double velocityAge(double now) const { return now - velocity_at_; }
  // s: longest time so far for which the motors moved the joints after the last velocity taken.
  double longestMotion() const { return longest_motion_; }
  // s since power-on.
  double time(double now) const { return now - power_on_; }

 private:
  aesop::Message answer(const aesop::Frame& request, double now);
  void execute(const aesop::Message& request, double now);
  void stop(double now);
  void watchHost(double now);
  void fault(std::uint16_t bits);
  aesop::Status status(double now) const;

  aesop::Kinematics kinematics_;
  Arm arm_;
  std::unique_ptr<aesop::Codec> codec_;
  double power_on_;
  aesop::RobotState state_ = aesop::RobotState::kDisabled;
  std::uint16_t cause_ = 0;
  std::uint16_t faults_ = 0;
  bool session_ = false;
  std::uint16_t last_sequence_ = 0;
  std::uint16_t reply_sequence_ = 0;
  double velocity_at_ = -std::numeric_limits<double>::infinity();
  double longest_motion_ = 0.0;
  double heard_ = 0.0;  // s: time of the last good frame
  Liar liar_;
  double velocity_until_ = 0.0;
  bool driven_ = false;  // a velocity is in force
};

}  // namespace laparoscope_servo::sim
