#include "laparoscope_servo/aesop/command_guard.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <sstream>

#include "laparoscope_servo/parameters/table.h"

namespace laparoscope_servo::aesop {

namespace {

// Share of the timeout after which the velocity fades to zero: at the controller's 50 Hz five commands may be late.
constexpr double kFullFor = 0.5;

}  // namespace

void describe(parameters::Table& table, CommandConfig& c) {
  table.number("timeout", c.timeout, {0.02, 2}, "s",
               "without a new command the velocity fades from half of it on, and is zero then");
  table.number("max_stamp_age", c.max_stamp_age, {0.02, 10}, "s", "a command whose stamp is older is refused");
  table.number("max_stamp_lead", c.max_stamp_lead, {0, 2}, "s",
               "a command whose stamp is further ahead is refused; allows for clocks that differ");
  table.number("max_pan", c.max_pan, {1e-4, 1}, "rad/s", "beyond a limit all four components are scaled alike");
  table.number("max_tilt", c.max_tilt, {1e-4, 1}, "rad/s", "beyond a limit all four components are scaled alike");
  table.number("max_spin", c.max_spin, {1e-4, 1}, "rad/s", "beyond a limit all four components are scaled alike");
  table.number("max_insertion", c.max_insertion, {1e-5, 0.2}, "m/s",
               "beyond a limit all four components are scaled alike");
}

std::vector<std::string> validate(const CommandConfig& config) {
  return parameters::errorsOf(config);
}

std::string CommandGuard::describe(Refusal refusal) const {
  switch (refusal) {
    case Refusal::kNotFinite:
      return "is not finite";
    case Refusal::kNoStamp:
      return "has no stamp";
    case Refusal::kOlderThanEnable:
      return "is older than the enable";
    case Refusal::kNotNewer:
      return "has a stamp that is not newer than that of the one before";
    case Refusal::kTooOld:
    case Refusal::kAhead:
      break;
  }
  std::ostringstream text;
  if (refusal == Refusal::kTooOld) {
    text << "has a stamp more than " << config_.max_stamp_age << " s old";
  } else {
    text << "is stamped more than " << config_.max_stamp_lead << " s ahead: compare the clocks of the machines";
  }
  return text.str();
}

std::string CommandGuard::accept(const scope::Velocity& velocity, double stamp, double stamp_now, double now) {
  if (stamp_now < last_stamp_now_) reset(stamp_now);  // the clock was set back: old stamps cannot be compared any more
  last_stamp_now_ = stamp_now;
  if (const std::optional<Refusal> refusal = judge(velocity, stamp, stamp_now)) {
    if (*refusal == Refusal::kNotFinite) forget();
    ++refused_[static_cast<std::size_t>(*refusal)];
    return "it " + describe(*refusal);
  }
  last_ = clamp(velocity);
  accepted_at_ = now;
  // A zero may have any stamp; one from the future must not refuse all later commands.
  if (stamp > last_stamp_ && stamp <= stamp_now + config_.max_stamp_lead) last_stamp_ = stamp;
  ++accepted_;
  return "";
}

std::optional<Refusal> CommandGuard::judge(const scope::Velocity& velocity, double stamp, double stamp_now) const {
  if (!velocity.isFinite()) return Refusal::kNotFinite;
  if (velocity.isZero()) return std::nullopt;
  if (!(stamp > 0.0)) return Refusal::kNoStamp;
  if (!(stamp > not_before_)) return Refusal::kOlderThanEnable;
  if (!(stamp > last_stamp_)) return Refusal::kNotNewer;
  if (!(stamp_now - stamp <= config_.max_stamp_age)) return Refusal::kTooOld;
  if (!(stamp - stamp_now <= config_.max_stamp_lead)) return Refusal::kAhead;
  return std::nullopt;
}

std::uint64_t CommandGuard::refused() const {
  return std::accumulate(refused_.begin(), refused_.end(), std::uint64_t{0});
}

scope::Velocity CommandGuard::clamp(const scope::Velocity& velocity) const {
  const double excess =
      std::max({std::abs(velocity.pan) / config_.max_pan, std::abs(velocity.tilt) / config_.max_tilt,
                std::abs(velocity.spin) / config_.max_spin, std::abs(velocity.insertion) / config_.max_insertion});
  if (excess <= 1.0) return velocity;
  return {velocity.pan / excess, velocity.tilt / excess, velocity.spin / excess, velocity.insertion / excess};
}

void CommandGuard::reset(double stamp_now) {
  forget();
  last_stamp_ = -std::numeric_limits<double>::infinity();
  not_before_ = last_stamp_now_ = stamp_now;
}

scope::Velocity CommandGuard::velocity(double now) const {
  if (!(age(now) <= config_.timeout)) return {};
  const double left = (config_.timeout - age(now)) / (config_.timeout * (1.0 - kFullFor));
  return left >= 1.0 ? last_ : scope::Velocity::fromVector(left * last_.vector());
}

}  // namespace laparoscope_servo::aesop
