// History of the commands to the robot, and the motion that they cause when each is executed after a delay.
#pragma once

#include <Eigen/Core>
#include <deque>

#include "laparoscope_servo/scope/velocity.h"

namespace laparoscope_servo::servo {

class CommandHistory {
 public:
  // Keeps the commands of the last `span` [s] > 0. The robot executes each for `lifetime` [s] > 0, then it stops by
  // itself.
  CommandHistory(double span, double lifetime) : span_(span), lifetime_(lifetime) {}

  // Adds the command for `time` [s] and later: the velocity of the shaft, after the robot's dead zone. Times must not
  // decrease; an earlier or non-finite one clears the history. A non-finite velocity counts as zero, since it is never
  // sent.
  void add(double time, const scope::Velocity& velocity);

  // (pan, tilt, spin [rad], insertion [m]) that the robot executes from `begin` to `end` [s], each command `delay` [s]
  // after its time; zero before the oldest command kept.
  Eigen::Vector4d displacement(double begin, double end, double delay) const;

  // Velocity that the robot executes at `time`.
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
