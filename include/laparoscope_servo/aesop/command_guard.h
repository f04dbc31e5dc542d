// Decides which commanded velocity of the scope is executed at this moment. A command that fails a check counts as zero
// velocity.
//
// Two clocks: `now` is seconds of a steady clock and measures the age of the last command; stamps and `stamp_now` are
// seconds of the clock that stamps messages (ROS time, perhaps simulated, perhaps stopped) and decide whether a command
// is newer than the last.
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
  double timeout = 0.2;         // s: without a new command the velocity fades from half of it on, and is zero then
  double max_stamp_age = 0.5;   // s: largest age of a command by its stamp
  double max_stamp_lead = 0.1;  // s: by which a stamp may be ahead of now, since clocks of two machines differ
  double max_pan = 0.15;        // rad/s; beyond a limit all four are scaled, so that the direction is kept
  double max_tilt = 0.15;       // rad/s
  double max_spin = 0.3;        // rad/s
  double max_insertion = 0.03;  // m/s
};

// Adds the rows of all parameters, with range and meaning.
void describe(parameters::Table& table, CommandConfig& config);

std::vector<std::string> validate(const CommandConfig& config);

// Reason why a command was refused.
enum class Refusal { kNotFinite, kNoStamp, kOlderThanEnable, kNotNewer, kTooOld, kAhead };
constexpr std::size_t kRefusals = 6;

class CommandGuard {
 public:
  explicit CommandGuard(const CommandConfig& config) : config_(config) {}

  // Accepts a command and returns an empty text, or returns why it is refused. A non-finite command is refused and
  // counts as zero. Zero is accepted with any stamp. Any other command needs a stamp that is newer than the last one
  // and than the last reset, and neither too old nor too far ahead of `stamp_now`.
  std::string accept(const scope::Velocity& velocity, double stamp, double stamp_now, double now);
  // Sets zero velocity until a command comes that was stamped after this moment.
  void reset(double stamp_now);
  // Sets zero velocity until the next command.
  void forget() { last_ = scope::Velocity(); }
  // The velocity to execute now: the last command's, from half of the timeout on the less the older it is.
  scope::Velocity velocity(double now) const;
  // s since the last command that was accepted; infinite before the first.
  double age(double now) const { return now - accepted_at_; }
  // Whether the last accepted command is older than the timeout.
  bool timedOut(double now) const { return !last_.isZero() && !(age(now) <= config_.timeout); }

  std::uint64_t accepted() const { return accepted_; }
  std::uint64_t refused() const;
  // Text that follows "it ".
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
