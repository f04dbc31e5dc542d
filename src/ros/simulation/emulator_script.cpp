#include "ros/simulation/emulator_script.h"

#include <algorithm>
#include <sstream>
#include <stdexcept>

#include "ros/common/parameters.h"

namespace laparoscope_servo {

namespace {

using XmlRpc::XmlRpcValue;

constexpr double kLongest = 1e6;  // s

bool isNumber(const XmlRpcValue& value) {
  return value.getType() == XmlRpcValue::TypeInt || value.getType() == XmlRpcValue::TypeDouble;
}

double number(XmlRpcValue value) {
  return value.getType() == XmlRpcValue::TypeInt ? static_cast<int>(value) : static_cast<double>(value);
}

std::string text(XmlRpcValue value) {
  if (value.getType() == XmlRpcValue::TypeString) return static_cast<std::string>(value);
  std::ostringstream stream;
  value.write(stream);
  return stream.str();
}

// One entry and its errors, which do not contain the entry's number yet.
class Entry {
 public:
  Entry(const XmlRpcValue& value, double previous) : value_(value) {
    if (value_.getType() != XmlRpcValue::TypeStruct) {
      complain("it is no mapping, expected {at: ..., fault: ...}");
      return;
    }
    static const char* const kKnown[] = {"at", "after", "fault", "value", "way", "for"};
    for (const auto& member : value_) {
      if (std::find(std::begin(kKnown), std::end(kKnown), member.first) == std::end(kKnown)) {
        complain("there is no '" + member.first + "', expected at or after, fault, value, way, for");
      }
    }
    readTime(previous);
    readFault();
  }

  const sim::ScheduledFault& fault() const { return fault_; }
  const std::vector<std::string>& errors() const { return errors_; }

 private:
  void complain(const std::string& error) { errors_.push_back(error); }

  void readTime(double previous) {
    if (value_.hasMember("at") == value_.hasMember("after")) {
      return complain("expected either at or after, in seconds");
    }
    const bool absolute = value_.hasMember("at");
    const std::string name = absolute ? "at" : "after";
    double seconds = 0.0;
    if (readNumber(name, seconds, 0.0)) fault_.at = absolute ? seconds : previous + seconds;
  }

  void readFault() {
    sim::Fault& fault = fault_.fault;
    if (!value_.hasMember("fault") || value_["fault"].getType() != XmlRpcValue::TypeString) {
      return complain("expected fault: the name of a fault");
    }
    fault.name = text(value_["fault"]);
    if (value_.hasMember("value")) {
      const XmlRpcValue& value = value_["value"];
      if (!isNumber(value) && value.getType() != XmlRpcValue::TypeString) {
        return complain("value = " + text(value) + ", expected a number or a name");
      }
      fault.value = text(value);
    }
    if (value_.hasMember("way")) fault.way = text(value_["way"]);
    if (value_.hasMember("for") && !readNumber("for", fault.duration, 0.0)) return;
    const std::string error = sim::error(fault);
    if (!error.empty()) complain(error);
  }

  bool readNumber(const std::string& name, double& result, double minimum) {
    const XmlRpcValue& value = value_[name];
    if (isNumber(value) && number(value) >= minimum && number(value) <= kLongest) {
      result = number(value);
      return true;
    }
    complain(name + " = " + text(value) + ", expected a number of seconds from 0 to 1000000");
    return false;
  }

  XmlRpcValue value_;
  sim::ScheduledFault fault_;
  std::vector<std::string> errors_;
};

}  // namespace

std::vector<sim::ScheduledFault> readScript(const XmlRpcValue& tree, std::vector<std::string>& errors) {
  std::vector<sim::ScheduledFault> script;
  XmlRpcValue root = tree;
  if (root.getType() != XmlRpcValue::TypeStruct || !root.hasMember("script") ||
      root["script"].getType() != XmlRpcValue::TypeArray) {
    errors.push_back("expected 'script:' with a list of entries");
    return script;
  }
  for (const auto& member : root) {
    if (member.first != "script") errors.push_back("there is no '" + member.first + "', expected 'script' alone");
  }
  double previous = 0.0;
  XmlRpcValue list = root["script"];
  for (int k = 0; k < list.size(); ++k) {
    const Entry entry(list[k], previous);
    for (const std::string& error : entry.errors()) {
      errors.push_back("entry " + std::to_string(k + 1) + ": " + error);
    }
    previous = entry.fault().at;
    script.push_back(entry.fault());
  }
  return script;
}

std::vector<sim::ScheduledFault> scriptFromYaml(const std::string& file) {
  std::vector<std::string> errors;
  std::vector<sim::ScheduledFault> script = readScript(parametersFromYaml(file), errors);
  if (errors.empty()) return script;
  std::string text = "script '" + file + "':";
  for (const std::string& error : errors) text += "\n  " + error;
  throw std::runtime_error(text);
}

}  // namespace laparoscope_servo
