// Who may call the services that lead to motion: the nodes that the configuration names, or every node.
//
// A caller's name is not authenticated in ROS 1, so this prevents mistakes, not attacks (doc/network.md).
#pragma once

#include <string>
#include <vector>

namespace laparoscope_servo {

class ServiceCallers {
 public:
  // `names`: resolved, e.g. "/theatre"; none: every node.
  explicit ServiceCallers(const std::vector<std::string>& names) : names_(names) {}

  // Why `caller`, as ros::ServiceEvent names it, may not call `service`; empty when it may.
  std::string refusal(const std::string& service, const std::string& caller) const;

 private:
  std::vector<std::string> names_;
};

}  // namespace laparoscope_servo
