#include "ros/common/input_owner.h"

#include <ros/names.h>

namespace laparoscope_servo {

namespace {

constexpr double kRemembered = 2.0;  // s, for which another publisher is reported
constexpr std::size_t kLongestName = 100;

}  // namespace

std::string shownName(const std::string& name) {
  std::string error;
  if (name.empty()) return "a node without a name";
  if (name.size() > kLongestName || !ros::names::validate(name, error)) return "a node whose name is none";
  return name;
}

InputOwner::Verdict InputOwner::judge(const std::string& sender, const Connection& connection, double now) {
  const bool may_own = name_.empty() || sender == name_;
  if (may_own && !connection_) {
    connection_ = connection;
    bound_ = sender;
  }
  if (may_own && connection_ == connection) return Verdict::kOwner;
  ++refused_;
  if (may_own && sender == bound_) return Verdict::kNewConnection;
  stranger_ = shownName(sender);
  stranger_at_ = now;
  return Verdict::kStranger;
}

std::string InputOwner::complaint(double now) const {
  if (!(now - stranger_at_ <= kRemembered)) return "";
  const std::string whose = name_.empty() ? shownName(bound_) + ", which spoke first," : name_;
  return what_ + " of " + stranger_ + " are refused, only those of " + whose + " count (parameter " + parameter_ + ")";
}

}  // namespace laparoscope_servo
