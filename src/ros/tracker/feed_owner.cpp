#include "ros/tracker/feed_owner.h"

#include "ros/common/input_owner.h"

namespace laparoscope_servo {

bool FeedOwner::counts(const std::string& sender, double now) {
  if (sender == owner_ || !(now - owner_at_ <= kSilence)) {
    owner_ = sender;
    owner_at_ = now;
    return true;
  }
  stranger_ = sender;
  stranger_at_ = now;
  ++refused_;
  return false;
}

std::string FeedOwner::complaint(double now) const {
  constexpr double kMemory = 5.0;  // s
  if (!(now - stranger_at_ <= kMemory)) return "";
  return "those of " + shownName(stranger_) + " are refused, " + shownName(owner_) + " sent first";
}

}  // namespace laparoscope_servo
