#include "servo/prediction/command_history.h"

#include <algorithm>
#include <cmath>

namespace laparoscope_servo::servo {

void CommandHistory::add(double time, const scope::Velocity& velocity) {
  if (!std::isfinite(time)) {
    clear();
    return;
  }
  if (!commands_.empty() && time < commands_.back().time) clear();
  commands_.push_back({time, velocity.isFinite() ? velocity.vector() : Eigen::Vector4d(Eigen::Vector4d::Zero())});
  // Keeps the command that was in force at the start of the span.
  while (commands_.size() > 1 && commands_[1].time <= time - span_) commands_.pop_front();
}

Eigen::Vector4d CommandHistory::displacement(double begin, double end, double delay) const {
  Eigen::Vector4d sum = Eigen::Vector4d::Zero();
  for (std::size_t k = 0; k < commands_.size(); ++k) {
    const double until = commands_[k].time + lifetime_;
    const double over = k + 1 < commands_.size() ? std::min(until, commands_[k + 1].time) : until;
    const double from = std::max(begin, commands_[k].time + delay), to = std::min(end, over + delay);
    if (to > from) sum += (to - from) * commands_[k].velocity;
  }
  return sum;
}

Eigen::Vector4d CommandHistory::velocity(double time, double delay) const {
  for (auto command = commands_.rbegin(); command != commands_.rend(); ++command) {
    if (command->time + delay > time) continue;
    if (time < command->time + lifetime_ + delay) return command->velocity;
    break;
  }
  return Eigen::Vector4d::Zero();
}

}  // namespace laparoscope_servo::servo
