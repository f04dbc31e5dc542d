// Whether the robot says that it moves against what it is told.
//
// The guard of effect believes the robot's own account of its motion. An axis that is reversed, and says so, fits its
// picture; what does not fit is the command.
#pragma once

#include <array>
#include <string>

#include "servo/prediction/command_history.h"

namespace laparoscope_servo::servo {

class OpposedMotion {
 public:
  // `width` of the robot's dead zone: slower motion is rest.
  explicit OpposedMotion(const scope::Velocity& width) : width_(width) {}

  // What the robot says that it did at `time` [s], and what it was told, to be executed after `delay` [s].
  void report(double time, const scope::Velocity& done, const CommandHistory& told, double delay);

  // Which axis goes the wrong way, in words; empty: none. It stays until restart().
  const std::string& words() const { return words_; }
  void restart();

 private:
  scope::Velocity width_;
  std::array<double, 4> since_{};  // s: from then on the axis has gone the wrong way
  std::array<bool, 4> opposed_{};
  std::string words_;
};

}  // namespace laparoscope_servo::servo
