// Decides when to try the port again: at once the first time, then after pauses that double, so that a missing port
// costs little. A session that lasted for stable_time resets the pauses; a shorter one (a loose cable) does not.
//
// Pure: `now` is seconds of a steady clock.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace laparoscope_servo::parameters {
class Table;
}

namespace laparoscope_servo::aesop {

// Defaults are those of config/aesop.yaml, group `reconnect`.
struct ReconnectConfig {
  double first_pause = 0.5;    // s
  double longest_pause = 8.0;  // s, first_pause to 60
  double stable_time = 5.0;    // s: a link that was up for this long was stable
};

// Adds the rows of all parameters, with range and meaning.
void describe(parameters::Table& table, ReconnectConfig& config);

std::vector<std::string> validate(const ReconnectConfig& config);

class Reconnect {
 public:
  explicit Reconnect(const ReconnectConfig& config) : config_(config), pause_(config.first_pause) {}

  bool due(double now) const { return now >= next_; }
  // s until the next attempt; 0 when it is due.
  double remaining(double now) const { return due(now) ? 0.0 : next_ - now; }
  // Call regularly while the link is up.
  void up(double now);
  // Call when an attempt has failed, or the port has been lost.
  void lost(double now);

 private:
  ReconnectConfig config_;
  double pause_;
  double next_ = 0.0;
  std::optional<double> up_since_;
};

}  // namespace laparoscope_servo::aesop
