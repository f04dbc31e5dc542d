// Laws that turn a task error into a velocity of the scope. A law is a pure function of its arguments: limits, dead
// zone and safety come after it.
#pragma once

#include "laparoscope_servo/scope/geometry.h"
#include "laparoscope_servo/scope/velocity.h"
#include "laparoscope_servo/servo/task_function.h"

namespace laparoscope_servo::servo {

// Velocity of a law, as the sum of two parts. They are limited separately, each with its direction kept, so that a
// large turn does not slow down the centring.
struct LawVelocity {
  scope::Velocity turning;   // for the ROI's orientation
  scope::Velocity centring;  // for the ROI's place in the image, and its depth
  scope::Velocity sum() const { return scope::Velocity::fromVector(turning.vector() + centring.vector()); }
};

class ControlLaw {
 public:
  virtual ~ControlLaw() = default;

  // Not finite if the arguments are not, or if the ROI's place does not determine the motion.
  virtual LawVelocity velocity(const TaskError& error, const scope::Geometry& scope) const = 0;
};

}  // namespace laparoscope_servo::servo
