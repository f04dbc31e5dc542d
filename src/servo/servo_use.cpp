#include "servo/servo_use.h"

namespace laparoscope_servo::servo {

ServoUse servoUse(Task task, const ControllerConfig& config) {
  if (task != Task::kStabilise) return {config.law, config.spin, true};
  // The paper's law is one of a region, by all four degrees of freedom.
  return {LawKind::kFeatures, config.stabilise.spin ? config.spin : SpinMode::kReleased, config.stabilise.insertion};
}

}  // namespace laparoscope_servo::servo
