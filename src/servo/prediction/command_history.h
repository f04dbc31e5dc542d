// What the robot has been told, and what it therefore has done and still will do, when it executes each command after a
// delay.
#pragma once

#include <Eigen/Core>
#include <deque>

#include "laparoscope_servo/scope/velocity.h"

namespace laparoscope_servo::servo {

class CommandHistory {
 public:
  // Keeps the commands of the last `span` [s] > 0. The robot takes each for `lifetime` [s] > 0, then it stops by
  // itself.
  CommandHistory(double span, double lifetime) : span_(span), lifetime_(lifetime) {}

  // From `time` [s] on, the robot is told to move by `velocity`: that of the shaft, after the robot's dead zone. Times
  // must not decrease; an earlier one, or one that is not finite, clears the history. A velocity that is not finite
  // counts as none: it is never sent.
  void add(double time, const scope::Velocity& velocity);

  // (pan, tilt, spin [rad], insertion [m]) that the robot executes from `begin` to `end` [s] when it does each thing
  // `delay` [s] after it is told. Before the first command, or the oldest that is kept, nothing is executed.
  Eigen::Vector4d displacement(double begin, double end, double delay) const;

  // What it executes at `time`.
  Eigen::Vector4d velocity(double time, double delay) const;

  void clear() { commands_.clear(); }

 private:
  struct Command {
    double time;
    Eigen::Vector4d velocity;
  };
  double span_;
  double lifetime_;
  std::deque<Command> commands_;
};

}  // namespace laparoscope_servo::servo
