// Which of the stamps of a stream count. Single ones that are doubled, out of order, zero or from the future are left
// out, and change nothing for those that follow; only a stream that stays behind where it was has begun anew.
#pragma once

#include <ros/time.h>

#include <cstdint>

namespace laparoscope_servo {

class StampGate {
 public:
  enum class Verdict {
    kCounts,
    kUnset,       // zero
    kRepeated,    // the last one again
    kLate,        // older than one that has counted
    kAhead,       // further ahead of now than clocks may differ
    kJumpedBack,  // counts: the stream goes on from an earlier time
  };

  // `tolerance`: s, by which clocks may differ, and stamps be out of order.
  explicit StampGate(double tolerance) : tolerance_(tolerance) {}

  Verdict judge(const ros::Time& stamp, const ros::Time& now);
  // Ahead alone, for streams whose order does not matter.
  bool isAhead(const ros::Time& stamp, const ros::Time& now);
  // Whatever comes next counts, unless it is unset or ahead.
  void clear();
  // Nothing else has come for a few messages.
  bool onlyAhead() const;
  bool onlyUnset() const;

  // Left out since the start.
  std::uint64_t unset() const { return unset_; }
  std::uint64_t repeated() const { return repeated_; }
  std::uint64_t late() const { return late_; }
  std::uint64_t ahead() const { return ahead_; }

 private:
  bool isBehind(const ros::Time& stamp);

  double tolerance_;
  ros::Time newest_;  // zero: none
  ros::Time behind_;  // the last of those in a row that lie further back than the tolerance
  int behind_in_a_row_ = 0;
  int ahead_in_a_row_ = 0;
  int unset_in_a_row_ = 0;
  std::uint64_t unset_ = 0;
  std::uint64_t repeated_ = 0;
  std::uint64_t late_ = 0;
  std::uint64_t ahead_ = 0;
};

}  // namespace laparoscope_servo
