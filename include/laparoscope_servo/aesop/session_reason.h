// Why a session is in its state.
#pragma once

#include <cstdint>
#include <string>

namespace laparoscope_servo::aesop {

struct SessionReason {
  enum class Kind {
    kNone,
    kNotEnabledYet,
    kEnableAskedFor,
    kGiven,  // `words`: given by the caller, the link or the motion monitor
    kFault,  // `faults`, as in Status
    kFaultNotCleared,
    kFaultCleared,
    kFaultGone,
    kHomingLost,
    kDisabledItself,
    kEnableNotConfirmed,
    kDisableConfirmedLate,
  };

  Kind kind = Kind::kNone;
  std::uint16_t faults = 0;
  std::string words = {};

  // Whether there is a fault.
  bool isFault() const { return kind == Kind::kFault || kind == Kind::kFaultNotCleared; }
};

// Text for the user; no decision may depend on it.
std::string text(const SessionReason& reason);

}  // namespace laparoscope_servo::aesop
