#include "laparoscope_servo/sim/lies.h"

#include <utility>

namespace laparoscope_servo::sim {

namespace {

constexpr std::pair<const char*, Lie> kNames[] = {
    {"disabled", Lie::kDisabled}, {"enabled", Lie::kEnabled},        {"healthy", Lie::kHealthy},
    {"standing", Lie::kStanding}, {"moving", Lie::kMoving},          {"frozen", Lie::kFrozen},
    {"jumped", Lie::kJumped},     {"echo_frozen", Lie::kEchoFrozen}, {"echo_ahead", Lie::kEchoAhead}};
constexpr double kJump = 0.2;           // m, rad
constexpr std::uint16_t kAhead = 1000;  // requests

}  // namespace

std::string lieNames() {
  std::string text;
  for (const auto& [name, lie] : kNames) text += (text.empty() ? "" : " ") + std::string(name);
  return text;
}

std::optional<Lie> lieNamed(const std::string& name) {
  if (name == "none") return Lie::kNone;
  for (const auto& [known, lie] : kNames) {
    if (name == known) return lie;
  }
  return std::nullopt;
}

void Liar::begin(Lie lie, const aesop::Status& truth) {
  lie_ = lie;
  beginning_ = truth;
}

aesop::Status Liar::tell(const aesop::Status& truth) const {
  aesop::Status status = truth;
  switch (lie_) {
    case Lie::kNone:
      break;
    case Lie::kDisabled:
      status.state = aesop::RobotState::kDisabled;
      break;
    case Lie::kEnabled:
      status.state = aesop::RobotState::kEnabled;
      break;
    case Lie::kHealthy:
      status.faults = 0;
      if (status.state == aesop::RobotState::kFault) status.state = aesop::RobotState::kEnabled;
      break;
    case Lie::kStanding:
      status.velocity.setZero();
      status.moving = false;
      break;
    case Lie::kMoving:
      status.moving = true;
      break;
    case Lie::kFrozen:
      status.position = beginning_.position;
      break;
    case Lie::kJumped:
      status.position.array() += kJump;
      break;
    case Lie::kEchoFrozen:
      status.echo = beginning_.echo;
      break;
    case Lie::kEchoAhead:
      status.echo = static_cast<std::uint16_t>(status.echo + kAhead);
      break;
  }
  return status;
}

}  // namespace laparoscope_servo::sim
