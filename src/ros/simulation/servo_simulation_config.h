// Parameters of the closed loop, see config/simulate_servo.yaml.
#pragma once

#include "laparoscope_servo/closed_loop/servo_simulation.h"
#include "ros/common/parameters.h"

namespace laparoscope_servo {

// Reads the group `simulation`; errors go to the reader.
closed_loop::SimulationConfig simulationConfig(ParameterReader& reader);

}  // namespace laparoscope_servo
