// How a task uses the servo: its law, and the degrees of freedom.
#pragma once

#include "laparoscope_servo/servo/controller_config.h"
#include "laparoscope_servo/servo/task.h"

namespace laparoscope_servo::servo {

struct ServoUse {
  LawKind law = LawKind::kFeatures;
  SpinMode spin = SpinMode::kServo;
  bool insertion = true;  // false: neither depth nor insertion is controlled

  LawAxes axes() const { return {spin != SpinMode::kReleased, insertion}; }
};

// For tasks that follow a picture.
ServoUse servoUse(Task task, const ControllerConfig& config);

}  // namespace laparoscope_servo::servo
