#include "ros/common/state_report.h"

namespace laparoscope_servo {

using aesop::LinkState;
using aesop::OperatingMode;

namespace {

// s, for the controller's first answer, which usually comes at once
constexpr double kFirstAnswer = 1.0;

}  // namespace

Severity severityOf(const aesop::OperatingState& state, const aesop::Session& session) {
  if (!session.link().isUp() || state.mode == OperatingMode::kFault || session.isUnconfirmed()) return Severity::kError;
  if (state.mode == OperatingMode::kPaused) return Severity::kWarning;
  if (state.mode == OperatingMode::kEnabled) return state.reason.empty() ? Severity::kInfo : Severity::kWarning;
  return session.stopped() ? Severity::kWarning : Severity::kInfo;
}

bool StateReport::isAwaited(const aesop::Session& session, double now) {
  const LinkState link = session.link().state();
  if (link == LinkState::kIdentifying && link_ == LinkState::kClosed) opened_at_ = now;
  // If the link was lost while the port stays open, it is reported as lost at once.
  if (link == LinkState::kIdentifying && link_ == LinkState::kUp) opened_at_ = now - kFirstAnswer;
  link_ = link;
  return link == LinkState::kIdentifying && now - opened_at_ < kFirstAnswer;
}

std::optional<StateLine> StateReport::take(const aesop::OperatingState& state, const aesop::Session& session,
                                           double now) {
  if (isAwaited(session, now)) return std::nullopt;
  std::string text = aesop::name(state.mode);
  if (!state.reason.empty()) text += ": " + state.reason;
  if (session.link().state() == LinkState::kClosed) text += "; trying again";
  const std::optional<std::string> line = lines_.take(text, now);
  if (!line) return std::nullopt;
  return StateLine{severityOf(state, session), *line};
}

}  // namespace laparoscope_servo
