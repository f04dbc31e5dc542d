// The messages between the driver and the arm's controller, independent of the wire format.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <variant>

#include "laparoscope_servo/aesop/kinematics_config.h"

namespace laparoscope_servo::aesop {

constexpr int kDrivenJoints = 4;
constexpr double kLargestNumber = 2000.0;  // magnitude of positions and velocities, m or rad (per second)

// Requests, from the host.
struct Identify {};    // begins a session; the controller is DISABLED after it
struct Enable {};      // from DISABLED to ENABLED, at rest
struct Disable {};     // to DISABLED, at rest
struct Stop {};        // stops, stays ENABLED
struct ClearFault {};  // from FAULT to DISABLED, if the cause has gone
struct Poll {};        // requests the status only
// Velocities of all driven joints, in the order of the arm. They are valid for `time_to_live` from their arrival, then
// the controller stops.
struct Velocity {
  std::array<double, kDrivenJoints> speed{};  // m/s for a prismatic joint, else rad/s; within ±2000
  double time_to_live = 0.0;                  // s, 0.001 to 2
};

// Replies, from the controller.
struct Identity {
  std::uint8_t joints = kJoints;
  std::uint8_t driven = 0;  // bit k - 1 for joint k
  std::string model;        // printable ASCII, at most 16 characters
};

enum class RobotState : std::uint8_t { kDisabled = 0, kEnabled = 1, kFault = 2 };

// Bits of Status::faults. A bit without a name here is a fault too.
constexpr std::uint16_t kFaultEmergencyStop = 0x0001;
constexpr std::uint16_t kFaultMotor = 0x0002;
constexpr std::uint16_t kFaultSensor = 0x0004;
constexpr std::uint16_t kFaultJointLimit = 0x0008;
constexpr std::uint16_t kFaultTrocar = 0x0010;  // the shaft cannot follow: wrist at its limit

struct Status {
  RobotState state = RobotState::kDisabled;
  bool homed = false;
  bool moving = false;       // a joint moves, or the controller executes a motion
  std::uint16_t faults = 0;  // 0: none
  std::uint16_t echo = 0;    // sequence number of the last request that the controller took
  double time = 0.0;         // s, the controller's clock, in steps of 1 ms; wraps after 49 days
  JointVector position = JointVector::Zero();
  JointVector velocity = JointVector::Zero();
};

using Message = std::variant<Identify, Enable, Disable, Stop, ClearFault, Poll, Velocity, Identity, Status>;

// "ENABLED" and so on.
const char* name(RobotState state);
// Names of the faults, joined by commas; empty for 0.
std::string describeFaults(std::uint16_t faults);

}  // namespace laparoscope_servo::aesop
