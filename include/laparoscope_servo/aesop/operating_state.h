// The arm's operating state, for the user and for recordings.
#pragma once

#include <string>

#include "laparoscope_servo/aesop/codec.h"

namespace laparoscope_servo::aesop {

// Names of the Collaborative Robotics Toolkit.
enum class OperatingMode { kDisabled, kEnabled, kPaused, kFault };

const char* name(OperatingMode mode);

struct OperatingState {
  OperatingMode mode = OperatingMode::kDisabled;
  bool is_homed = false;
  bool is_busy = false;  // the arm moves, or a request waits for its confirmation
  std::string reason;

  bool operator==(const OperatingState& other) const {
    return mode == other.mode && is_homed == other.is_homed && is_busy == other.is_busy && reason == other.reason;
  }
};

// Form in a recording: a byte for the mode, one for the flags, the reason. The inverse throws std::invalid_argument.
Bytes payloadOf(const OperatingState& state);
OperatingState stateOf(const Bytes& payload);

}  // namespace laparoscope_servo::aesop
