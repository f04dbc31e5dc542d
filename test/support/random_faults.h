// Random fault scripts for the node and for its core: what is drawn, and what has to hold after it.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "laparoscope_servo/sim/faults.h"
#include "laparoscope_servo/sim/lies.h"

namespace laparoscope_servo::test {

// Arm at its defaults, driver at its defaults, line at 38,400 baud.
struct StopBounds {
  double time_to_live = 0.2;
  double delay = 0.16;
  // A joint at its highest speed until friction holds it: time_constant * ln(max_speed / dead_zone), for joint 7.
  double braking = 0.03 * std::log(0.5 / 4e-3);
  double line = 27.0 * 10.0 / 38400.0;  // a velocity on its way
  // After the last velocity has arrived.
  double afterArrival() const { return time_to_live + delay + braking; }
  // After the host has ceased to send velocities.
  double afterSending() const { return line + afterArrival(); }
};

struct FaultScript {
  std::vector<sim::ScheduledFault> entries;

  // s: when the last fault ends.
  double end() const {
    double end = 0.0;
    for (const auto& [at, fault] : entries)
      end = std::max(end, at + (std::isfinite(fault.duration) ? fault.duration : 0));
    return end;
  }
  // s: what the line may hold back a velocity for. A controller that hears nothing for longer than its host timeout
  // disables itself, so that no single fault can add more.
  double heldBack() const {
    double sum = 0.0;
    for (const auto& [at, fault] : entries) {
      if (fault.way == "to_host") continue;
      if (fault.name == "delay") sum += std::min(std::stod(fault.value), sim::kHostTimeout);
      if (fault.name == "stall") sum += std::min(fault.duration, sim::kHostTimeout);
    }
    return sum;
  }
  // s: the beginning of the first fault that has to stop the arm without anybody's help; infinite when none has.
  double stopsAt() const {
    double first = std::numeric_limits<double>::infinity();
    for (const auto& [at, fault] : entries) {
      if (hasToStop(fault)) first = std::min(first, at);
    }
    return first;
  }
  bool has(const std::string& name) const {
    return std::any_of(entries.begin(), entries.end(), [&](const auto& entry) { return entry.fault.name == name; });
  }
  // Whether the driver may be misled about where the joints are, or a joint does not obey: until it notices, the scope
  // does not move as commanded.
  bool misleads() const { return has("lie") || has("stalled") || has("joint"); }
  // As lines of the control socket.
  std::vector<std::string> requests() const {
    std::vector<std::string> lines;
    for (const auto& [at, fault] : entries) {
      std::ostringstream line;
      line << "after " << at << " fault " << fault.name << ' ' << fault.value << ' ' << fault.way;
      if (std::isfinite(fault.duration)) line << " for " << fault.duration;
      lines.push_back(line.str());
    }
    return lines;
  }
  std::string text() const {
    std::string all;
    for (const std::string& line : requests()) all += (all.empty() ? "" : "; ") + line;
    return all;
  }

 private:
  static bool hasToStop(const sim::Fault& fault) {
    if (fault.name == "hangup" || fault.name == "reboot" || fault.name == "bits" || fault.name == "joint") return true;
    const bool reaches_controller = fault.way != "to_host";
    const bool long_enough = fault.duration > sim::kHostTimeout + 0.1;
    if (fault.name == "stall") return reaches_controller && long_enough;
    if (fault.name == "drop" || fault.name == "corrupt") {
      return reaches_controller && long_enough && std::stod(fault.value) > 0.6;  // of 27 bytes, none is spared
    }
    return false;
  }
};

class RandomFaults {
 public:
  explicit RandomFaults(unsigned seed) : random_(seed) {}

  FaultScript draw() {
    FaultScript script;
    const int count = 1 + whole(3);
    double at = 0.0;
    for (int k = 0; k < count; ++k) {
      at += real(0.0, 0.4);
      script.entries.push_back({rounded(at), one()});
    }
    return script;
  }

  double real(double from, double to) { return std::uniform_real_distribution<double>(from, to)(random_); }
  int whole(int count) { return std::uniform_int_distribution<int>(0, count - 1)(random_); }

 private:
  static double rounded(double value) { return std::round(value * 1000.0) / 1000.0; }

  sim::Fault one() {
    static const char* const kNames[] = {"drop",   "corrupt", "double", "delay",   "stall", "hangup",
                                         "reboot", "bits",    "joint",  "stalled", "lie",   "lie"};
    static const char* const kWays[] = {"", "to_controller", "to_host"};
    sim::Fault fault;
    fault.name = kNames[whole(12)];
    const bool of_bytes = fault.name == "drop" || fault.name == "corrupt" || fault.name == "double";
    if (fault.name != "reboot") fault.duration = rounded(real(0.03, 1.2));
    if (of_bytes || fault.name == "delay" || fault.name == "stall") fault.way = kWays[whole(3)];
    if (of_bytes) fault.value = std::to_string(std::pow(10.0, real(-3.0, 0.0)));
    if (fault.name == "delay") fault.value = std::to_string(real(0.0, 1.0));
    if (fault.name == "bits") fault.value = std::to_string(1 << whole(16));
    if (fault.name == "joint" || fault.name == "stalled") fault.value = std::to_string(1 + whole(7));
    if (fault.name == "lie") fault.value = lie();
    return fault;
  }

  std::string lie() {
    std::istringstream names(sim::lieNames());
    std::vector<std::string> all;
    for (std::string name; names >> name;) all.push_back(name);
    return all[static_cast<std::size_t>(whole(static_cast<int>(all.size())))];
  }

  std::mt19937 random_;
};

}  // namespace laparoscope_servo::test
