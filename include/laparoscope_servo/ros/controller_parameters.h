// Parameters of the controller node, see config/controller.yaml.
#pragma once

#include <string>

#include "laparoscope_servo/ros/external_stops.h"
#include "laparoscope_servo/ros/parameters.h"
#include "laparoscope_servo/servo/controller_config.h"

namespace laparoscope_servo::skin {

struct ControllerNodeConfig {
  double rate = 50.0;                               // Hz, of the commands
  std::string insertion_point = "insertion_point";  // tf frame, O_A
  std::string camera = "laparoscope_optical";       // tf frame, O_C
  std::string shaft = "scope_tip";                  // tf frame with its z axis along the shaft, into the body
  servo::ControllerConfig control;
  ExternalStopsConfig external_stops;
};

// Reads what is set, keeps the defaults for the rest. Errors, also those of servo::validate, go to the reader.
ControllerNodeConfig controllerNodeConfig(ParameterReader& reader);

// The part of it that simulate_servo shares.
servo::ControllerConfig controllerConfig(ParameterReader& reader);

}  // namespace laparoscope_servo::skin
