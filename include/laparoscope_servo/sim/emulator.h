// The far end of the line: the controller of an AESOP as doc/aesop_protocol.md describes it, with an emulated arm
// behind it.
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

// Every error, the name of its group in front.
// Rows for all of it: ranges and meanings.
void describe(parameters::Table& table, EmulatorConfig& config);
// Without the group `kinematics`, which is the arm's.
void describeEmulator(parameters::Table& table, EmulatorConfig& config);

std::vector<std::string> validate(const EmulatorConfig& config);

// s without a good frame from the host, in ENABLED, after which the controller disables itself. It also keeps what a
// line held back for longer from moving the arm when it comes after all.
constexpr double kHostTimeout = 0.5;

class Emulator {
 public:
  // Throws std::invalid_argument, as Arm does. `now`: power-on.
  Emulator(const EmulatorConfig& config, double now);

  // Takes bytes from the line, and gives back what goes onto it.
  aesop::Bytes receive(const std::uint8_t* data, std::size_t size, double now);
  // Lets time pass; the velocity runs out on time, however long the step.
  void step(double now);

  // The cause of a fault: it is there until called with 0. The fault itself stays until the host clears it.
  void setFaultCause(std::uint16_t bits, double now);
  // A joint stands whatever is commanded, without a fault: index 0 to 6; -1 for none.
  void jam(int joint, double now);
  // Statuses lie from now on.
  void lie(Lie lie, double now);
  // As if switched off and on; the arm stays where it is.
  void reboot(double now);
  // A hand moves the scope: see Arm::hand. Refused unless DISABLED.
  std::string hand(const scope::Velocity& displacement, double seconds, double now);

  const Arm& arm() const { return arm_; }
  aesop::RobotState state() const { return state_; }
  std::uint16_t faults() const { return faults_; }
  // s since the last velocity other than zero was taken; infinite before the first.
  double velocityAge(double now) const { return now - velocity_at_; }
  // s: how long the motors have moved the joints after the last velocity taken, at most, so far.
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
  double heard_ = 0.0;  // s: the last good frame
  Liar liar_;
  double velocity_until_ = 0.0;
  bool driven_ = false;  // a velocity counts
};

}  // namespace laparoscope_servo::sim
