// Decides whose messages a topic that should have one publisher is taken from: the first node that sends on it, until
// it falls silent. What another node sends meanwhile is refused: two cameras on one topic are no film.
#pragma once

#include <cstdint>
#include <limits>
#include <string>

namespace laparoscope_servo {

// Times are seconds of any steady clock.
class FeedOwner {
 public:
  static constexpr double kSilence = 2.0;  // s, after which another node's messages are taken

  // Whether a message of the node `sender` counts. A node that starts again keeps its name.
  bool counts(const std::string& sender, double now);

  const std::string& owner() const { return owner_; }
  std::uint64_t refused() const { return refused_; }
  // Whose messages are refused; empty when none has come for a while.
  std::string complaint(double now) const;

 private:
  std::string owner_;
  double owner_at_ = -std::numeric_limits<double>::infinity();
  std::string stranger_;
  double stranger_at_ = -std::numeric_limits<double>::infinity();
  std::uint64_t refused_ = 0;
};

}  // namespace laparoscope_servo
