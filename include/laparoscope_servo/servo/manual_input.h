// Velocity commanded by a stick, a slider or a pad.
#pragma once

#include <limits>

#include "laparoscope_servo/scope/velocity.h"

namespace laparoscope_servo::servo {

struct ManualInput {
  scope::Velocity velocity;
  double age = std::numeric_limits<double>::infinity();  // s, since the command
};

}  // namespace laparoscope_servo::servo
