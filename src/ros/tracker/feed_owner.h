// Decides whose messages are accepted on a topic that should have one publisher: those of the first node, until it is
// silent. Messages of other nodes are refused, since images of two cameras are no sequence.
#pragma once

#include <cstdint>
#include <limits>
#include <string>

namespace laparoscope_servo {

// Times are seconds of any steady clock.
class FeedOwner {
 public:
  static constexpr double kSilence = 2.0;  // s, silence after which another node's messages are accepted

  // Whether a message of the node `sender` is accepted. A restarted node keeps its name.
  bool counts(const std::string& sender, double now);

  const std::string& owner() const { return owner_; }
  std::uint64_t refused() const { return refused_; }
  // Whose messages are refused; empty if none has come for a while.
  std::string complaint(double now) const;

 private:
  std::string owner_;
  double owner_at_ = -std::numeric_limits<double>::infinity();
  std::string stranger_;
  double stranger_at_ = -std::numeric_limits<double>::infinity();
  std::uint64_t refused_ = 0;
};

}  // namespace laparoscope_servo
