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
  std::string file;              // file in which a calibrated insertion point is saved; empty: not saved
  bool pattern_allowed = false;  // the calibration may move the arm, without a dead-man switch
  servo::InsertionPointFitConfig fit;
  aesop::PatternConfig pattern;
};

struct AesopParameters {
  aesop::DriverConfig driver;
  aesop::ReconnectConfig reconnect;
  std::string port;  // required
  int baud_rate = 38400;
  int realtime_priority = 0;           // priority of the loop, 0: none
  std::string insertion_point_file;    // file of a calibration that replaces insertion_point; empty: none
  std::string insertion_point_origin;  // source of driver.insertion_point, for display
  CalibrationParameters calibration;
  std::string frame_prefix = "auto";  // in front of every frame's name; auto: see frame_names.h
  // Node whose velocity commands are accepted; a name without a leading slash is in the node's namespace.
  std::string publisher = "controller";
  // Nodes that may call the services that allow motion: enable, resume, clear_fault, the calibration; empty: every
  // node.
  std::vector<std::string> service_callers;
  aesop::WireLogConfig wire_log;
  ExternalStopsConfig external_stops;
  double optics_angle = 0.0;  // rad, between the shaft and the optical axis
  double optics_roll = 0.0;   // rad, of the camera about the shaft
};

// Adds the rows of all parameters of the node.
void describe(parameters::Table& table, AesopParameters& parameters);
std::vector<std::string> validate(const AesopParameters& parameters);

// Missing parameters keep their defaults. The reader collects all errors.
AesopParameters readAesopParameters(ParameterReader& reader);
sim::EmulatorConfig readEmulatorConfig(ParameterReader& reader);
// Errors in `tree` outside of the groups `kinematics` and `emulator`. One file may describe the arm for both ends:
// parameters of the aesop node are allowed, but must be valid; others are errors.
std::vector<std::string> errorsBesideEmulator(const XmlRpc::XmlRpcValue& tree);

}  // namespace laparoscope_servo
