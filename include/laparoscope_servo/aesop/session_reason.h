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
    kGiven,  // `words`: by who asked for it, by the link, by who watches the arm
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

  // Tells of a fault that there is.
  bool isFault() const { return kind == Kind::kFault || kind == Kind::kFaultNotCleared; }
};

// For the user. Nothing may depend on these words.
std::string text(const SessionReason& reason);

}  // namespace laparoscope_servo::aesop
