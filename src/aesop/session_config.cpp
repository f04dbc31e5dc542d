#include "laparoscope_servo/aesop/session_config.h"

#include <sstream>

#include "laparoscope_servo/aesop/codec.h"

namespace laparoscope_servo::aesop {

namespace {

void check(const char* field, double value, double minimum, double maximum, std::vector<std::string>& errors) {
  if (value >= minimum && value <= maximum) return;
  std::ostringstream text;
  text << field << " = " << value << ", expected a number from " << minimum << " to " << maximum;
  errors.push_back(text.str());
}

}  // namespace

std::vector<std::string> validate(const SessionConfig& config) {
  std::vector<std::string> errors;
  check("rate", config.rate, 5.0, 200.0, errors);
  check("time_to_live", config.time_to_live, 0.01, 2.0, errors);
  check("status_timeout", config.status_timeout, 0.05, 5.0, errors);
  check("request_timeout", config.request_timeout, 0.1, 10.0, errors);
  if (errors.empty() && !(config.time_to_live * config.rate >= 2.0)) {
    std::ostringstream text;
    text << "time_to_live = " << config.time_to_live << ", expected at least two periods of rate = " << config.rate
         << " Hz, or the arm stutters";
    errors.push_back(text.str());
  }
  return errors;
}

std::string lineWarning(const SessionConfig& config, int baud_rate) {
  constexpr double kBitsPerByte = 10.0;  // 8N1
  const double needed = config.rate * (kFrameOverhead + kLargestPayload) * kBitsPerByte;
  if (needed <= 0.9 * baud_rate) return "";
  std::ostringstream text;
  text << "statuses at " << config.rate << " Hz need " << needed << " bit/s, the line carries " << baud_rate
       << ": lower the rate to at most " << static_cast<int>(0.9 * baud_rate * config.rate / needed)
       << " Hz or raise the baud rate";
  return text.str();
}

}  // namespace laparoscope_servo::aesop
