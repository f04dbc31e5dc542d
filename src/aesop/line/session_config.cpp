#include "laparoscope_servo/aesop/session_config.h"

#include <algorithm>
#include <sstream>

#include "laparoscope_servo/parameters/table.h"

namespace laparoscope_servo::aesop {

void describe(parameters::Table& table, SessionConfig& c) {
  table.number("rate", c.rate, {5, 200}, "Hz", "requests to the controller, each answered by its status");
  table.number("time_to_live", c.time_to_live, {0.01, 2}, "s",
               "validity of a velocity, at least 2 / rate; without a new one the controller then stops by itself");
  table.number("status_timeout", c.status_timeout, {0.05, 5}, "s",
               "longest time without a status; then the link is lost");
  table.number("request_timeout", c.request_timeout, {0.1, 10}, "s",
               "longest time for the controller to confirm a request");
  describeCodec(table, c.codec);
}

void describeCodec(parameters::Table& table, CodecFactory& codec) {
  const std::vector<std::string> names = codecNames();
  table.choice(
      "codec", names,
      [names, &codec] {  // a codec of a program that links the driver is on no list and has no name in files
        const auto found = std::find_if(names.begin(), names.end(), [&codec](const std::string& name) {
          return codec && codecNamed(name)()->name() == codec()->name();
        });
        return found == names.end() ? std::size_t{0} : static_cast<std::size_t>(found - names.begin());
      },
      [names, &codec](std::size_t k) { codec = codecNamed(names[k]); },
      "the wire format; own is the only one in this package");
}

std::vector<std::string> validate(const SessionConfig& config) {
  if (!config.codec) return {"codec: there is none, expected one that makes a codec"};
  std::vector<std::string> errors = parameters::errorsOf(config);
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
  const double needed = config.rate * static_cast<double>(config.codec()->longestFrame()) * kBitsPerByte;
  if (needed <= 0.9 * baud_rate) return "";
  std::ostringstream text;
  text << "statuses at " << config.rate << " Hz need " << needed << " bit/s, the line carries " << baud_rate
       << ": lower the rate to at most " << static_cast<int>(0.9 * baud_rate * config.rate / needed)
       << " Hz or raise the baud rate";
  return text.str();
}

}  // namespace laparoscope_servo::aesop
