#include "ros/common/said_lines.h"

#include <algorithm>

namespace laparoscope_servo {

namespace {

constexpr double kBurst = 10.0;  // lines at once
constexpr double kRate = 2.0;    // lines per second, for ever

}  // namespace

std::optional<std::string> SaidLines::take(const std::string& text, double now) {
  if (any_ && text == said_ && now - said_at_ < repeat_) {
    missed_.clear();
    return std::nullopt;
  }
  allowance_ = std::min(kBurst, allowance_ + kRate * std::min(now - filled_at_, kBurst));
  filled_at_ = now;
  if (allowance_ < 1.0) {
    if (text != missed_) ++missing_;
    missed_ = text;
    return std::nullopt;
  }
  allowance_ -= 1.0;
  const std::uint64_t missing = missing_ - (text == missed_ && missing_ > 0 ? 1 : 0);
  said_ = text;
  any_ = true;
  said_at_ = now;
  missing_ = 0;
  missed_.clear();
  return missing == 0 ? text : text + " (" + std::to_string(missing) + " changes before it are not shown)";
}

}  // namespace laparoscope_servo
