// Parameters of simulate_servo: those of the controller, and the group `simulation` of the simulated world.
#pragma once

#include <string>
#include <vector>

#include "laparoscope_servo/closed_loop/servo_simulation.h"
#include "ros/controller/controller_parameters.h"

namespace laparoscope_servo::closed_loop {

// Adds the rows without the group's name.
void describe(parameters::Table& table, SimulationConfig& config);
std::vector<std::string> validate(const SimulationConfig& config);

}  // namespace laparoscope_servo::closed_loop

namespace laparoscope_servo {

struct ServoSimulationParameters {
  ControllerNodeConfig controller;
  closed_loop::SimulationConfig simulation;
};

void describe(parameters::Table& table, ServoSimulationParameters& parameters);
std::vector<std::string> validate(const ServoSimulationParameters& parameters);

}  // namespace laparoscope_servo
