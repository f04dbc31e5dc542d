// Laws that turn a task error into a velocity of the scope. A law is a pure function of its arguments: limits, dead
// zone and safety come after it.
#pragma once

#include "laparoscope_servo/scope/geometry.h"
#include "laparoscope_servo/scope/velocity.h"
#include "laparoscope_servo/servo/task_function.h"

namespace laparoscope_servo::servo {

// What a law asks for, in two parts that add up. They are limited apart, since a long way to turn need not slow down
// the centring; each keeps its direction.
struct LawVelocity {
  scope::Velocity turning;   // for the ROI's orientation
  scope::Velocity centring;  // for its place in the image, and its depth
  scope::Velocity sum() const { return scope::Velocity::fromVector(turning.vector() + centring.vector()); }
};

class ControlLaw {
 public:
  virtual ~ControlLaw() = default;

  // Not finite where the arguments are not, or where the ROI's place does not determine the motion.
  virtual LawVelocity velocity(const TaskError& error, const scope::Geometry& scope) const = 0;
};

}  // namespace laparoscope_servo::servo
