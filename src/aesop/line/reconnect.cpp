#include "laparoscope_servo/aesop/reconnect.h"

#include <algorithm>

#include "laparoscope_servo/parameters/table.h"

namespace laparoscope_servo::aesop {

void describe(parameters::Table& table, ReconnectConfig& c) {
  table.number("first_pause", c.first_pause, {0.05, 10}, "s", "each further pause is twice as long");
  table.number("longest_pause", c.longest_pause, {0.05, 60}, "s", "no pause is longer").atLeast("first_pause");
  table.number("stable_time", c.stable_time, {0, 3600}, "s", "a link that was up for this long resets the pauses");
}

std::vector<std::string> validate(const ReconnectConfig& config) {
  return parameters::errorsOf(config);
}

void Reconnect::up(double now) {
  if (!up_since_) up_since_ = now;
}

void Reconnect::lost(double now) {
  if (up_since_ && now - *up_since_ >= config_.stable_time) pause_ = config_.first_pause;
  up_since_.reset();
  next_ = now + pause_;
  pause_ = std::min(2.0 * pause_, config_.longest_pause);
}

}  // namespace laparoscope_servo::aesop
