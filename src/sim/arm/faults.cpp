#include "laparoscope_servo/sim/faults.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "laparoscope_servo/sim/lies.h"

namespace laparoscope_servo::sim {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kLongest = 1e6;  // s, latest time of a schedule

enum class Takes { kNothing, kProbability, kDelay, kPerhapsSeconds, kMask, kJoint, kFactor, kLie };

struct Kind {
  const char* name;
  Takes takes;
  bool of_line;   // has a direction
  bool can_last;  // may have a duration
  const char* help;
};

constexpr Kind kKinds[] = {
    {"drop", Takes::kProbability, true, true, "bytes get lost"},
    {"corrupt", Takes::kProbability, true, true, "one bit of a byte flips"},
    {"double", Takes::kProbability, true, true, "bytes come twice"},
    {"delay", Takes::kDelay, true, true, "bytes come later"},
    {"stall", Takes::kPerhapsSeconds, true, true, "bytes wait on the line, and come together at the end"},
    {"hangup", Takes::kPerhapsSeconds, false, true, "the port goes away"},
    {"return", Takes::kNothing, false, false, "the port comes back"},
    {"reboot", Takes::kNothing, false, false, "the controller restarts"},
    {"bits", Takes::kMask, false, true, "cause of a robot fault, until 0"},
    {"joint", Takes::kJoint, false, true, "the motor of a joint trips: it stands, and that is a robot fault"},
    {"stalled", Takes::kJoint, false, true, "a joint stands, and the controller does not notice"},
    {"reversed", Takes::kJoint, false, true, "a joint moves the other way than it is told, and says so"},
    {"gain", Takes::kFactor, false, true, "the joints move by this factor of their commands"},
    {"lag", Takes::kDelay, false, true, "commands take effect later"},
    {"lie", Takes::kLie, false, true, "statuses that are not true"},
    {"none", Takes::kNothing, false, false, "a good line, a good arm, true statuses; a robot fault waits for the host"},
};

const Kind* kindOf(const std::string& name) {
  const auto found = std::find_if(std::begin(kKinds), std::end(kKinds), [&](const Kind& k) { return name == k.name; });
  return found == std::end(kKinds) ? nullptr : found;
}

// NaN when it is not a number.
double number(const std::string& text) {
  std::istringstream stream(text);
  double value = 0.0;
  return (stream >> value) && stream.eof() ? value : std::nan("");
}

std::string expected(Takes takes) {
  switch (takes) {
    case Takes::kNothing:
      return "no value";
    case Takes::kProbability:
      return "a probability from 0 to 1";
    case Takes::kDelay:
      return "0 to 10 s";
    case Takes::kPerhapsSeconds:
      return "a number of seconds; 0 or nothing: until it is undone";
    case Takes::kMask:
      return "a whole number from 0 to 65535";
    case Takes::kJoint:
      return "a joint's number, 1 to 7, or 0 for none";
    case Takes::kFactor:
      return "a factor from -10 to 10";
    case Takes::kLie:
      return "one of " + lieNames() + " none";
  }
  return "";
}

bool accepts(Takes takes, const std::string& text) {
  if (takes == Takes::kNothing) return text.empty();
  if (takes == Takes::kLie) return lieNamed(text).has_value();
  if (takes == Takes::kPerhapsSeconds && text.empty()) return true;
  const double value = number(text);
  const bool whole = value == std::floor(value);
  switch (takes) {
    case Takes::kProbability:
      return value >= 0.0 && value <= 1.0;
    case Takes::kDelay:
      return value >= 0.0 && value <= 10.0;
    case Takes::kPerhapsSeconds:
      return value >= 0.0 && value <= kLongest;
    case Takes::kMask:
      return whole && value >= 0.0 && value <= 65535.0;
    case Takes::kJoint:
      return whole && value >= 0.0 && value <= aesop::kJoints;
    case Takes::kFactor:
      return value >= -10.0 && value <= 10.0;
    default:
      return false;
  }
}

std::string quoted(const std::string& text) {
  return "'" + text + "'";
}

}  // namespace

std::string error(const Fault& fault) {
  const Kind* kind = kindOf(fault.name);
  if (kind == nullptr) return "there is no fault " + quoted(fault.name);
  if (!accepts(kind->takes, fault.value)) {
    return fault.name + " takes " + expected(kind->takes) + (fault.value.empty() ? "" : ", not " + quoted(fault.value));
  }
  if (!fault.way.empty() && fault.way != "to_controller" && fault.way != "to_host") {
    return quoted(fault.way) + " is no direction, expected to_controller or to_host";
  }
  if (!fault.way.empty() && !kind->of_line) return fault.name + " has no direction";
  if (std::isinf(fault.duration) && fault.duration > 0.0) return "";
  if (!kind->can_last) return fault.name + " does not last";
  if (!(fault.duration > 0.0 && fault.duration <= kLongest)) return "a fault lasts more than 0, at most 1000000 s";
  return "";
}

std::string faultHelp() {
  std::string text;
  for (const Kind& kind : kKinds) {
    const std::string name = kind.name;
    text += "  " + name + std::string(name.size() < 9 ? 9 - name.size() : 1, ' ') + kind.help + "; " +
            expected(kind.takes) + "\n";
  }
  return text;
}

std::string Faults::begin(const Fault& fault, double now) {
  const std::string problem = error(fault);
  if (!problem.empty()) return problem;
  set(fault, now);
  if (std::isfinite(fault.duration)) add({now + fault.duration, fault, true});
  return "";
}

std::string Faults::schedule(const ScheduledFault& fault, double now) {
  if (!(fault.at >= 0.0 && fault.at <= kLongest)) return "a fault begins after 0 to 1000000 s";
  const std::string problem = error(fault.fault);
  if (problem.empty()) add({now + fault.at, fault.fault, false});
  return problem;
}

void Faults::add(const Event& event) {
  const auto later = [](const Event& a, const Event& b) { return a.at < b.at; };
  schedule_.insert(std::upper_bound(schedule_.begin(), schedule_.end(), event, later), event);
}

void Faults::step(double now) {
  while (!schedule_.empty() && schedule_.front().at <= now) {
    const Event event = schedule_.front();
    schedule_.erase(schedule_.begin());
    if (event.ends) {
      undo(event.fault, now);
    } else {
      begin(event.fault, now);
    }
  }
}

double Faults::next() const {
  return schedule_.empty() ? kInfinity : schedule_.front().at;
}

void Faults::set(const Fault& fault, double now) {
  const double value = number(fault.value);
  const double until = value > 0.0 ? now + value : kInfinity;
  for (WireDirection* way : {&wire_.to_controller, &wire_.to_host}) {
    if (fault.way == (way == &wire_.to_host ? "to_controller" : "to_host")) continue;
    if (fault.name == "drop") way->faults.drop = value;
    if (fault.name == "corrupt") way->faults.corrupt = value;
    if (fault.name == "double") way->faults.duplicate = value;
    if (fault.name == "delay") way->faults.delay = value;
    if (fault.name == "stall") way->faults.stalled_until = until;
  }
  if (fault.name == "hangup") wire_.cut(until);
  if (fault.name == "return") wire_.cut(now);
  if (fault.name == "reboot") emulator_.reboot(now);
  if (fault.name == "bits") emulator_.setFaultCause(static_cast<std::uint16_t>(value), now);
  if (fault.name == "joint" || fault.name == "stalled") emulator_.jam(static_cast<int>(value) - 1, now);
  if (fault.name == "joint") emulator_.setFaultCause(value > 0.0 ? aesop::kFaultMotor : 0, now);
  if (fault.name == "reversed") emulator_.reverse(static_cast<int>(value) - 1, now);
  if (fault.name == "gain") emulator_.setGain(value, now);
  if (fault.name == "lag") emulator_.setLag(value, now);
  if (fault.name == "lie") emulator_.lie(*lieNamed(fault.value), now);
  if (fault.name == "none") clear(now);
}

void Faults::undo(const Fault& fault, double now) {
  Fault end = fault;
  end.value = "0";
  if (fault.name == "lie") end.value = "none";
  if (fault.name == "gain") end.value = "1";
  if (fault.name == "hangup") end.name = "return";
  if (fault.name != "stall") return set(end, now);
  if (fault.way != "to_host") wire_.to_controller.faults.stalled_until = now;
  if (fault.way != "to_controller") wire_.to_host.faults.stalled_until = now;
}

void Faults::clear(double now) {
  wire_.to_controller.faults = wire_.to_host.faults = WireFaults();
  if (wire_.isCut(now)) wire_.cut(now);
  emulator_.setFaultCause(0, now);
  emulator_.jam(-1, now);
  emulator_.reverse(-1, now);
  emulator_.setGain(1.0, now);
  emulator_.setLag(0.0, now);
  emulator_.lie(Lie::kNone, now);
}

}  // namespace laparoscope_servo::sim
