// What a stick, a slider or a pad says.
#pragma once

#include <limits>

#include "laparoscope_servo/scope/velocity.h"

namespace laparoscope_servo::servo {

struct ManualInput {
  scope::Velocity velocity;
  double age = std::numeric_limits<double>::infinity();  // s
};

}  // namespace laparoscope_servo::servo
