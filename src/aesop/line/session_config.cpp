#include "laparoscope_servo/aesop/session_config.h"

#include <sstream>

#include "laparoscope_servo/validation/range_checker.h"

namespace laparoscope_servo::aesop {

std::vector<std::string> validate(const SessionConfig& config) {
  validation::RangeChecker check;
  if (!config.codec) check.add("codec: there is none, expected one that makes a codec");
  check.range("rate", config.rate, 5.0, 200.0);
  check.range("time_to_live", config.time_to_live, 0.01, 2.0);
  check.range("status_timeout", config.status_timeout, 0.05, 5.0);
  check.range("request_timeout", config.request_timeout, 0.1, 10.0);
  if (check.errors().empty() && !(config.time_to_live * config.rate >= 2.0)) {
    std::ostringstream text;
    text << "time_to_live = " << config.time_to_live << ", expected at least two periods of rate = " << config.rate
         << " Hz, or the arm stutters";
    check.add(text.str());
  }
  return check.errors();
}

std::string lineWarning(const SessionConfig& config, int baud_rate) {
  constexpr double kBitsPerByte = 10.0;  // 8N1
  const double needed = config.rate * static_cast<double>(config.codec()->longestFrame()) * kBitsPerByte;
  if (needed <= 0.9 * baud_rate) return "";
  std::ostringstream text;
  text << "statuses at " << config.rate << " Hz need " << needed << " bit/s, the line carries " << baud_rate
       << ": lower the rate to at most " << static_cast<int>(0.9 * baud_rate * config.rate / needed)
       << " Hz or raise the baud rate";
  return text.str();
}

}  // namespace laparoscope_servo::aesop
