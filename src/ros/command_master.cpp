#include "laparoscope_servo/ros/command_master.h"

#include <ros/names.h>

namespace laparoscope_servo::skin {

namespace {

constexpr double kRemembered = 2.0;  // s, that a stranger is complained about
constexpr std::size_t kLongestName = 100;

}  // namespace

std::string shownName(const std::string& name) {
  std::string error;
  if (name.empty()) return "a node without a name";
  if (name.size() > kLongestName || !ros::names::validate(name, error)) return "a node whose name is none";
  return name;
}

CommandMaster::Verdict CommandMaster::judge(const std::string& sender, const Connection& connection, double now) {
  if (sender != name_) {
    ++refused_;
    stranger_ = shownName(sender);
    stranger_at_ = now;
    return Verdict::kStranger;
  }
  if (!connection_) connection_ = connection;
  if (connection_ == connection) return Verdict::kMaster;
  ++refused_;
  return Verdict::kNewConnection;
}

std::string CommandMaster::complaint(double now) const {
  if (!(now - stranger_at_ <= kRemembered)) return "";
  return "commands of " + stranger_ + " are refused, only those of " + name_ + " count (parameter command/publisher)";
}

}  // namespace laparoscope_servo::skin
