// Decides which stamps of a stream are accepted. Single stamps that are repeated, out of order, zero or in the future
// are refused and do not affect later ones; a stream whose stamps stay earlier than before has begun anew.
#pragma once

#include <ros/time.h>

#include <cstdint>

namespace laparoscope_servo {

class StampGate {
 public:
  enum class Verdict {
    kCounts,
    kUnset,       // zero
    kRepeated,    // equal to the last one
    kLate,        // older than an accepted one
    kAhead,       // further ahead of now than the tolerance
    kJumpedBack,  // accepted: the stream goes on from an earlier time
  };

  // `tolerance`: s, allowed difference of clocks, and of stamps out of order.
  explicit StampGate(double tolerance) : tolerance_(tolerance) {}

  Verdict judge(const ros::Time& stamp, const ros::Time& now);
  // Checks for kAhead only, for streams whose order does not matter.
  bool isAhead(const ros::Time& stamp, const ros::Time& now);
  // Accepts any next stamp that is not unset or ahead.
  void clear();
  // Whether the last few stamps were all ahead.
  bool onlyAhead() const;
  bool onlyUnset() const;

  // Numbers of refused stamps since the start.
  std::uint64_t unset() const { return unset_; }
  std::uint64_t repeated() const { return repeated_; }
  std::uint64_t late() const { return late_; }
  std::uint64_t ahead() const { return ahead_; }

 private:
  bool isBehind(const ros::Time& stamp);

  double tolerance_;
  ros::Time newest_;  // zero: none
  ros::Time behind_;  // the last of the present row of stamps that are further back than the tolerance
  int behind_in_a_row_ = 0;
  int ahead_in_a_row_ = 0;
  int unset_in_a_row_ = 0;
  std::uint64_t unset_ = 0;
  std::uint64_t repeated_ = 0;
  std::uint64_t late_ = 0;
  std::uint64_t ahead_ = 0;
};

}  // namespace laparoscope_servo
