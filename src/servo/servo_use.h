// How a task uses the servo: its law, the degrees of freedom, what it knows of its target.
#pragma once

#include <optional>

#include "laparoscope_servo/servo/controller_config.h"
#include "laparoscope_servo/servo/task.h"

namespace laparoscope_servo::servo {

struct ServoUse {
  LawKind law = LawKind::kFeatures;
  SpinMode spin = SpinMode::kServo;
  bool insertion = true;  // false: neither depth nor insertion is controlled
  // The target moves as tissue does, and is followed ahead of its image. False: a hand moves it, it may stop or turn at
  // any time, and is taken to be at rest. It may be brought anywhere in the workspace, so the leash begins anew each
  // time that the scope stands.
  bool is_tissue = true;
  std::optional<RestConfig> rest;  // bands of rest of its own; empty: those of the configuration

  LawAxes axes() const { return {spin != SpinMode::kReleased, insertion}; }
};

// For tasks that follow a picture.
ServoUse servoUse(Task task, const ControllerConfig& config);

}  // namespace laparoscope_servo::servo
