// Decides which velocity of the scope counts at this moment. What does not convince is zero.
//
// Two clocks: `now` is seconds of a steady clock and measures the age of the last command; stamps and `stamp_now` are
// seconds of the clock that stamps messages (ROS time, perhaps simulated, perhaps standing) and tell whether a command
// is news.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "laparoscope_servo/aesop/scope_motion.h"

namespace laparoscope_servo::parameters {
class Table;
}

namespace laparoscope_servo::aesop {

// Defaults are those of config/aesop.yaml, group `command`.
struct CommandConfig {
  double timeout = 0.2;         // s: a command that no other follows counts no longer
  double max_stamp_age = 0.5;   // s: between a command's stamp and now
  double max_stamp_lead = 0.1;  // s: a stamp may be ahead of now, as clocks of two machines differ
  double max_pan = 0.15;        // rad/s; beyond a limit all four are scaled, so that the direction is kept
  double max_tilt = 0.15;       // rad/s
  double max_spin = 0.3;        // rad/s
  double max_insertion = 0.03;  // m/s
};

// Rows for all of it: ranges and meanings.
void describe(parameters::Table& table, CommandConfig& config);

std::vector<std::string> validate(const CommandConfig& config);

// Why a command does not count.
enum class Refusal { kNotFinite, kNoStamp, kOlderThanEnable, kNotNewer, kTooOld, kAhead };
constexpr std::size_t kRefusals = 6;

class CommandGuard {
 public:
  explicit CommandGuard(const CommandConfig& config) : config_(config) {}

  // Takes a command, or says why not. One that is not finite is a zero. A zero is taken whatever its stamp. Any other
  // needs a stamp that is newer than the last one and than the last reset, neither too old nor ahead of `stamp_now`.
  std::string accept(const scope::Velocity& velocity, double stamp, double stamp_now, double now);
  // Zero until a command comes that was stamped after this moment.
  void reset(double stamp_now);
  // Zero until the next command.
  void forget() { last_ = scope::Velocity(); }
  // The command that counts now.
  scope::Velocity velocity(double now) const;
  // s since the last command that was accepted; infinite before the first.
  double age(double now) const { return now - accepted_at_; }
  // Whether the last command accepted has run out.
  bool timedOut(double now) const { return !last_.isZero() && !(age(now) <= config_.timeout); }

  std::uint64_t accepted() const { return accepted_; }
  std::uint64_t refused() const;
  // In words that follow "it ".
  std::string describe(Refusal refusal) const;
  std::uint64_t refused(Refusal refusal) const { return refused_[static_cast<std::size_t>(refusal)]; }

 private:
  std::optional<Refusal> judge(const scope::Velocity& velocity, double stamp, double stamp_now) const;
  scope::Velocity clamp(const scope::Velocity& velocity) const;

  CommandConfig config_;
  scope::Velocity last_;
  double accepted_at_ = -std::numeric_limits<double>::infinity();
  double last_stamp_ = -std::numeric_limits<double>::infinity();
  double not_before_ = -std::numeric_limits<double>::infinity();
  double last_stamp_now_ = -std::numeric_limits<double>::infinity();
  std::uint64_t accepted_ = 0;
  std::array<std::uint64_t, kRefusals> refused_{};
};

}  // namespace laparoscope_servo::aesop
