// Lines on the terminal about the operating state: every change of the state or of its reason, with a log level.
#pragma once

#include <optional>
#include <string>

#include "laparoscope_servo/aesop/session.h"
#include "ros/common/said_lines.h"

namespace laparoscope_servo {

enum class Severity { kInfo, kWarning, kError };

struct StateLine {
  Severity severity = Severity::kInfo;
  std::string text;
};

// ERROR: FAULT, no connection, a disable that the arm does not confirm. WARNING: PAUSED, DISABLED by something else
// than a request, ENABLED but not executing the command. INFO: the rest.
Severity severityOf(const aesop::OperatingState& state, const aesop::Session& session);

class StateReport {
 public:
  // Call at every step. `state`: the session's, perhaps with a longer reason. `now`: s, steady.
  std::optional<StateLine> take(const aesop::OperatingState& state, const aesop::Session& session, double now);

 private:
  bool isAwaited(const aesop::Session& session, double now);

  SaidLines lines_;
  aesop::LinkState link_ = aesop::LinkState::kClosed;
  double opened_at_ = 0.0;  // s: when the port was opened, if no answer has come since
};

}  // namespace laparoscope_servo
