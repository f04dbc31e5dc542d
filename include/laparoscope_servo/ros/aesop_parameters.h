// Parameters of the aesop node and of the emulator: config/aesop.yaml and config/emulator.yaml name every one, with its
// unit.
#pragma once

#include <string>

#include "laparoscope_servo/aesop/calibration_pattern.h"
#include "laparoscope_servo/aesop/driver.h"
#include "laparoscope_servo/ros/parameters.h"
#include "laparoscope_servo/servo/insertion_point_fit.h"
#include "laparoscope_servo/sim/emulator.h"

namespace laparoscope_servo::skin {

struct CalibrationParameters {
  std::string file;  // where a calibrated insertion point is saved; empty: nowhere
  servo::InsertionPointFitConfig fit;
  aesop::PatternConfig pattern;
};

struct AesopParameters {
  aesop::DriverConfig driver;
  std::string port;                    // required
  int baud_rate = 38400;               // 1200 to 1000000
  std::string insertion_point_file;    // a calibration that takes the place of insertion_point; empty: none
  std::string insertion_point_origin;  // where driver.insertion_point is from, in words
  CalibrationParameters calibration;
  std::string frame_prefix;   // in front of every frame's name
  double optics_angle = 0.0;  // rad, between the shaft and the optical axis, -1.3 to 1.3
  double optics_roll = 0.0;   // rad, of the camera about the shaft, -3.2 to 3.2
};

// Missing parameters keep their defaults. All errors are left in the reader.
AesopParameters readAesopParameters(ParameterReader& reader);
sim::EmulatorConfig readEmulatorConfig(ParameterReader& reader);

}  // namespace laparoscope_servo::skin
