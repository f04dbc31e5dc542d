// All parameters of the controller, with the defaults that config/controller.yaml repeats.
#pragma once

#include <string>
#include <vector>

#include "laparoscope_servo/servo/control_law.h"
#include "laparoscope_servo/servo/dead_zone.h"
#include "laparoscope_servo/servo/limiter.h"
#include "laparoscope_servo/servo/safety_config.h"

namespace laparoscope_servo::servo {

struct ControllerConfig {
  PaperGains gains;
  DeadZoneConfig dead_zone;
  Limits limits;
  SafetyConfig safety;
};

// Every error, each naming the field, its value and what was expected; empty when there is none.
std::vector<std::string> validate(const ControllerConfig& config);

}  // namespace laparoscope_servo::servo
