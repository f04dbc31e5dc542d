#include "servo/servo_use.h"

namespace laparoscope_servo::servo {

namespace {

// Of turningParallel(). The goal's place in the image is about two and a half times as far off as the axis is turned,
// so the scope stops within 0.1 and starts beyond 0.3 degrees; the noise of poses is 0.05 degrees once it is filtered.
constexpr double kParallelStop = 0.004;   // normalised
constexpr double kParallelStart = 0.012;  // normalised

// What is seen has neither depth nor orientation, or none that counts.
ServoUse panAndTilt() {
  ServoUse use;
  use.spin = SpinMode::kReleased;
  use.insertion = false;
  return use;
}

// The band of rest of what does not move as tissue does.
void restBetween(double stop, double start, const ControllerConfig& config, ServoUse& use) {
  use.is_tissue = false;
  use.rest = config.rest;
  use.rest->enabled = true;
  use.rest->centre_stop = stop;
  use.rest->centre_start = start;
}

// The paper's law is one of a region, by all four degrees of freedom.
ServoUse stabilising(const ControllerConfig& config) {
  ServoUse use;
  use.spin = config.stabilise.spin ? config.spin : SpinMode::kReleased;
  use.insertion = config.stabilise.insertion;
  return use;
}

// The zone is a band of rest that is never widened: a tip that comes back to its border does not make it grow.
ServoUse centringTip(const ControllerConfig& config) {
  ServoUse use = panAndTilt();
  restBetween(config.centre_tip.inner, config.centre_tip.zone, config, use);
  use.rest->widening = 1.0;
  return use;
}

// Their error is that of a displacement of the scope; the paper's law is one of the numbers of a homography.
ServoUse byDisplacement(const ControllerConfig& config) {
  ServoUse use;
  use.spin = config.spin;
  return use;
}

// The goal is at rest in the arm's base, and known by poses.
ServoUse turningParallel(const ControllerConfig& config) {
  ServoUse use = panAndTilt();
  restBetween(kParallelStop, kParallelStart, config, use);
  return use;
}

}  // namespace

ServoUse servoUse(Task task, const ControllerConfig& config) {
  if (task == Task::kStabilise) return stabilising(config);
  if (task == Task::kCentreTip) return centringTip(config);
  if (task == Task::kFollow) return panAndTilt();
  if (task == Task::kPoints || task == Task::kPosition) return byDisplacement(config);
  if (task == Task::kParallel) return turningParallel(config);
  ServoUse use;
  use.law = config.law;
  use.spin = config.spin;
  return use;
}

}  // namespace laparoscope_servo::servo
