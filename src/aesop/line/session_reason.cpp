#include "laparoscope_servo/aesop/session_reason.h"

#include "laparoscope_servo/aesop/messages.h"

namespace laparoscope_servo::aesop {

namespace {

std::string faultText(std::uint16_t faults) {
  const std::string names = describeFaults(faults);
  return "fault: " + (names.empty() ? std::string("the controller names no cause") : names);
}

}  // namespace

std::string text(const SessionReason& reason) {
  using Kind = SessionReason::Kind;
  switch (reason.kind) {
    case Kind::kNone:
      return "";
    case Kind::kNotEnabledYet:
      return "not enabled yet";
    case Kind::kEnableAskedFor:
      return "enable asked for";
    case Kind::kGiven:
      return reason.words;
    case Kind::kFault:
      return faultText(reason.faults);
    case Kind::kFaultNotCleared:
      return faultText(reason.faults) + "; it could not be cleared";
    case Kind::kFaultCleared:
      return "fault cleared";
    case Kind::kFaultGone:
      return "the fault has gone by itself";
    case Kind::kHomingLost:
      return "the arm has lost its homing: its joint positions mean nothing";
    case Kind::kDisabledItself:
      return "the controller has disabled itself";
    case Kind::kEnableNotConfirmed:
      return "the controller has not confirmed the enable";
    case Kind::kDisableConfirmedLate:
      return "disabled; the controller has confirmed it late";
  }
  return "";
}

}  // namespace laparoscope_servo::aesop
