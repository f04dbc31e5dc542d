#include "laparoscope_servo/aesop/reconnect.h"

#include <algorithm>

#include "laparoscope_servo/validation/range_checker.h"

namespace laparoscope_servo::aesop {

std::vector<std::string> validate(const ReconnectConfig& config) {
  validation::RangeChecker check;
  check.range("first_pause", config.first_pause, 0.05, 10.0);
  check.range("longest_pause", config.longest_pause, std::max(0.05, config.first_pause), 60.0);
  check.range("stable_time", config.stable_time, 0.0, 3600.0);
  return check.errors();
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
