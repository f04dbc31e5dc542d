// Statuses that are not true: what a broken sensor, or a controller gone mad, would say.
#pragma once

#include <optional>
#include <string>

#include "laparoscope_servo/aesop/messages.h"

namespace laparoscope_servo::sim {

enum class Lie {
  kNone,
  kDisabled,    // says DISABLED
  kEnabled,     // says ENABLED
  kHealthy,     // says that there is no fault; FAULT is called ENABLED
  kStanding,    // no velocities, and nothing moves
  kMoving,      // always moving
  kFrozen,      // positions stay those of the beginning of the lie
  kJumped,      // positions are off by 0.2 m or rad
  kEchoFrozen,  // claims that it took no further request
  kEchoAhead,   // claims requests that were never sent
};

// "disabled", "echo_frozen" and so on, separated by blanks, without "none".
std::string lieNames();
// Of these names and of "none".
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
