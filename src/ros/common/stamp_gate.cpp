#include "ros/common/stamp_gate.h"

namespace laparoscope_servo {

namespace {

// So many stamps in a row are no outliers.
constexpr int kLasting = 3;

}  // namespace

StampGate::Verdict StampGate::judge(const ros::Time& stamp, const ros::Time& now) {
  if (stamp.isZero()) {
    ++unset_;
    ++unset_in_a_row_;
    return Verdict::kUnset;
  }
  unset_in_a_row_ = 0;
  if (isAhead(stamp, now)) return Verdict::kAhead;
  if (stamp == newest_) {
    ++repeated_;
    return Verdict::kRepeated;
  }
  const bool late = stamp < newest_;
  if (late && !isBehind(stamp)) {
    ++late_;
    return Verdict::kLate;
  }
  newest_ = stamp;
  behind_in_a_row_ = 0;
  return late ? Verdict::kJumpedBack : Verdict::kCounts;
}

bool StampGate::isAhead(const ros::Time& stamp, const ros::Time& now) {
  const bool ahead = stamp.toSec() - now.toSec() > tolerance_;
  ahead_ += ahead ? 1 : 0;
  ahead_in_a_row_ = ahead ? ahead_in_a_row_ + 1 : 0;
  return ahead;
}

// Whether the stream has begun anew: several in a row, each newer than the last.
bool StampGate::isBehind(const ros::Time& stamp) {
  if ((newest_ - stamp).toSec() <= tolerance_) return false;
  behind_in_a_row_ = behind_in_a_row_ > 0 && stamp > behind_ ? behind_in_a_row_ + 1 : 1;
  behind_ = stamp;
  return behind_in_a_row_ >= kLasting;
}

void StampGate::clear() {
  newest_ = ros::Time();
  behind_in_a_row_ = ahead_in_a_row_ = unset_in_a_row_ = 0;
}

bool StampGate::onlyAhead() const {
  return ahead_in_a_row_ >= kLasting;
}

bool StampGate::onlyUnset() const {
  return unset_in_a_row_ >= kLasting;
}

}  // namespace laparoscope_servo
