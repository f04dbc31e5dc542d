// Detects that the robot reports motion opposite to its commands.
//
// The effect guard relies on the reported motion. If an axis is reversed and reports so, picture and report agree; only
// the command does not. The time for which an axis moves in the wrong direction is summed up until it moves in the
// right one: where the scope is held again and again, none of its motions may last long enough.
#pragma once

#include <array>
#include <string>

#include "servo/prediction/command_history.h"

namespace laparoscope_servo::servo {

class OpposedMotion {
 public:
  // `width`: of the robot's dead zone; slower motion counts as rest.
  explicit OpposedMotion(const scope::Velocity& width) : width_(width) {}

  // Takes the velocity reported for `time` [s], and the commands, which are executed after `delay` [s].
  void report(double time, const scope::Velocity& done, const CommandHistory& told, double delay);

  // Text that names the axis which moves in the wrong direction; empty: none. Stays until restart().
  const std::string& words() const { return words_; }
  void restart();

 private:
  scope::Velocity width_;
  double last_time_ = 0.0;               // s, of the last report
  std::array<double, 4> opposed_for_{};  // s, for which the axis has moved in the wrong direction
  std::array<bool, 4> opposed_{};        // in the last report
  std::string words_;
};

}  // namespace laparoscope_servo::servo
