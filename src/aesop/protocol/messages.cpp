#include "laparoscope_servo/aesop/messages.h"

#include <sstream>
#include <utility>

namespace laparoscope_servo::aesop {

const char* name(RobotState state) {
  switch (state) {
    case RobotState::kDisabled:
      return "DISABLED";
    case RobotState::kEnabled:
      return "ENABLED";
    case RobotState::kFault:
      return "FAULT";
  }
  return "unknown";
}

std::string describeFaults(std::uint16_t faults) {
  const std::pair<std::uint16_t, const char*> names[] = {{kFaultEmergencyStop, "emergency stop"},
                                                         {kFaultMotor, "motor"},
                                                         {kFaultSensor, "joint sensor"},
                                                         {kFaultJointLimit, "joint limit"},
                                                         {kFaultTrocar, "the shaft cannot follow the trocar"}};
  std::string text;
  for (const auto& [bit, what] : names) {
    if ((faults & bit) == 0) continue;
    text += (text.empty() ? "" : ", ") + std::string(what);
    faults = static_cast<std::uint16_t>(faults & ~bit);
  }
  if (faults != 0) {
    std::ostringstream unknown;
    unknown << "unknown fault bits 0x" << std::hex << faults;
    text += (text.empty() ? "" : ", ") + unknown.str();
  }
  return text;
}

}  // namespace laparoscope_servo::aesop
