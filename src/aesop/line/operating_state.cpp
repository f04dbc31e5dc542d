#include "laparoscope_servo/aesop/operating_state.h"

#include <algorithm>
#include <stdexcept>

namespace laparoscope_servo::aesop {

const char* name(OperatingMode mode) {
  switch (mode) {
    case OperatingMode::kDisabled:
      return "DISABLED";
    case OperatingMode::kEnabled:
      return "ENABLED";
    case OperatingMode::kPaused:
      return "PAUSED";
    case OperatingMode::kFault:
      return "FAULT";
  }
  return "unknown";
}

Bytes payloadOf(const OperatingState& state) {
  Bytes bytes(2 + state.reason.size());
  bytes[0] = static_cast<std::uint8_t>(state.mode);
  bytes[1] = static_cast<std::uint8_t>((state.is_homed ? 1 : 0) + (state.is_busy ? 2 : 0));
  std::copy(state.reason.begin(), state.reason.end(), bytes.begin() + 2);
  return bytes;
}

OperatingState stateOf(const Bytes& payload) {
  if (payload.size() < 2 || payload[0] > static_cast<std::uint8_t>(OperatingMode::kFault) || payload[1] > 3) {
    throw std::invalid_argument("a state that is none");
  }
  return {static_cast<OperatingMode>(payload[0]), (payload[1] & 1) != 0, (payload[1] & 2) != 0,
          std::string(payload.begin() + 2, payload.end())};
}

}  // namespace laparoscope_servo::aesop
