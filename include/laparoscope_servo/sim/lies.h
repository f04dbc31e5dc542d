// False statuses: those of a broken sensor, or of a faulty controller.
#pragma once

#include <optional>
#include <string>

#include "laparoscope_servo/aesop/messages.h"

namespace laparoscope_servo::sim {

enum class Lie {
  kNone,
  kDisabled,    // reports DISABLED
  kEnabled,     // reports ENABLED
  kHealthy,     // reports no fault, and ENABLED instead of FAULT
  kStanding,    // reports zero velocities and rest
  kMoving,      // always reports motion
  kFrozen,      // reports the positions of the beginning of the lie
  kJumped,      // reports positions that are wrong by 0.2 m or rad
  kEchoFrozen,  // reports that it took no further request
  kEchoAhead,   // reports requests that were never sent
};

// "disabled", "echo_frozen" and so on, separated by blanks, without "none".
std::string lieNames();
// The lie of one of these names or of "none".
std::optional<Lie> lieNamed(const std::string& name);

class Liar {
 public:
  // `truth`: the status at this moment.
  void begin(Lie lie, const aesop::Status& truth);
  aesop::Status tell(const aesop::Status& truth) const;

 private:
  Lie lie_ = Lie::kNone;
  aesop::Status beginning_;
};

}  // namespace laparoscope_servo::sim
