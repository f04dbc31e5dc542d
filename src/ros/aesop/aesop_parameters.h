// Parameters of the aesop node and of the emulator.
#pragma once

#include <string>
#include <vector>

#include "laparoscope_servo/aesop/calibration_pattern.h"
#include "laparoscope_servo/aesop/driver.h"
#include "laparoscope_servo/aesop/reconnect.h"
#include "laparoscope_servo/aesop/wire_log_file.h"
#include "laparoscope_servo/servo/insertion_point_fit.h"
#include "laparoscope_servo/sim/emulator.h"
#include "ros/common/external_stops.h"
#include "ros/common/parameters.h"

namespace laparoscope_servo {

struct CalibrationParameters {
  std::string file;              // where a calibrated insertion point is saved; empty: nowhere
  bool pattern_allowed = false;  // the arm may be moved by it, though no dead-man switch is asked
  servo::InsertionPointFitConfig fit;
  aesop::PatternConfig pattern;
};

struct AesopParameters {
  aesop::DriverConfig driver;
  aesop::ReconnectConfig reconnect;
  std::string port;  // required
  int baud_rate = 38400;
  int realtime_priority = 0;           // of the loop, 0: none
  std::string insertion_point_file;    // a calibration that takes the place of insertion_point; empty: none
  std::string insertion_point_origin;  // where driver.insertion_point is from, in words
  CalibrationParameters calibration;
  std::string frame_prefix = "auto";  // in front of every frame's name; auto: see frame_names.h
  // Node whose velocity commands count; a name without a leading slash is one of the node's namespace.
  std::string publisher = "controller";
  // Nodes that may call what lets the arm move: enable, resume, clear_fault, the calibration; none: every node.
  std::vector<std::string> service_callers;
  aesop::WireLogConfig wire_log;
  ExternalStopsConfig external_stops;
  double optics_angle = 0.0;  // rad, between the shaft and the optical axis
  double optics_roll = 0.0;   // rad, of the camera about the shaft
};

// All parameters of the node.
void describe(parameters::Table& table, AesopParameters& parameters);
std::vector<std::string> validate(const AesopParameters& parameters);

// Missing parameters keep their defaults. All errors are left in the reader.
AesopParameters readAesopParameters(ParameterReader& reader);
sim::EmulatorConfig readEmulatorConfig(ParameterReader& reader);
// Errors of what `tree` holds besides the groups `kinematics` and `emulator`: one file may describe the arm for both
// ends, so that parameters of the aesop node are allowed, but have to be right; others are not.
std::vector<std::string> errorsBesideEmulator(const XmlRpc::XmlRpcValue& tree);

}  // namespace laparoscope_servo
